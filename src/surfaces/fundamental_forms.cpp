#include "surfaces/fundamental_forms.hpp"

#include <algorithm>

#include "elementary_functions/power.hpp"

namespace surfmesh {
namespace {

// |r_u x r_v| / (E + G), the sine of r_u and r_v times their ratio: below it second derivatives
// divided by it keep no digits
constexpr double DEGENERATE = 1e-10;

}  // namespace

FundamentalForms fundamental_forms(Point3 ru, Point3 rv, const SecondDerivatives& second) {
    const double E = lane_dot(ru, ru), F = lane_dot(ru, rv), G = lane_dot(rv, rv);
    const Point3 across = cross(ru, rv);
    const double length = std::sqrt(lane_dot(across, across));
    const double by = length > 0.0 ? length : 1.0;
    Point3 n = {across.x / by, across.y / by, across.z / by};
    const bool degenerate = !(length > DEGENERATE * (E + G));
    if (degenerate) n = {0.0, 0.0, 0.0};
    const double L = lane_dot(second.uu, n), M = lane_dot(second.uv, n);
    return {E, F, G, L, M, lane_dot(second.vv, n), n, degenerate};
}

PrincipalCurvatures principal_curvatures(const FundamentalForms& forms) {
    if (forms.degenerate) return {0.0, 0.0};
    const auto& [E, F, G, L, M, N, normal, degenerate] = forms;
    const double a = std::sqrt(E), b = F / a;
    double c = std::sqrt(std::max(E * G - F * F, 0.0)) / a;
    if (!(c > 0.0)) c = 1.0;
    const double s11 = L / (a * a);
    const double s12 = (M - b * L / a) / (a * c);
    const double s22 = (N - 2.0 * b * M / a + b * b * L / (a * a)) / (c * c);
    const double mean = 0.5 * (s11 + s22), half = 0.5 * (s11 - s22);
    const double radius = elementary::hypot(half, s12);
    return {mean + radius, mean - radius};
}

}  // namespace surfmesh
