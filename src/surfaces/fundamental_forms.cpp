#include "surfaces/fundamental_forms.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/power.hpp"
#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh {
namespace {

// |r_u x r_v| / (E + G), the sine of r_u and r_v times their ratio: below it second derivatives
// divided by it keep no digits
constexpr double DEGENERATE = 1e-10;

// (k1 - k2) / (|k1| + |k2|): below it the principal directions are round-off
constexpr double UMBILIC = 1e-13;

/// S = (mean + half, s12; s12, mean - half) in the frame of C = (a 0; b c), see there.
struct ShapeOperator {
    double a, b, c, mean, half, s12;
};

ShapeOperator shape_operator(const FundamentalForms& forms) {
    const auto& [E, F, G, L, M, N, normal, degenerate] = forms;
    const double a = std::sqrt(E), b = F / a;
    double c = std::sqrt(std::max(E * G - F * F, 0.0)) / a;
    if (!(c > 0.0)) c = 1.0;
    const double s11 = L / (a * a);
    const double s12 = (M - b * L / a) / (a * c);
    const double s22 = (N - 2.0 * b * M / a + b * b * L / (a * a)) / (c * c);
    return {a, b, c, 0.5 * (s11 + s22), 0.5 * (s11 - s22), s12};
}

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
    const ShapeOperator s = shape_operator(forms);
    const double radius = elementary::hypot(s.half, s.s12);
    return {s.mean + radius, s.mean - radius};
}

PrincipalDirections principal_directions(const FundamentalForms& forms) {
    if (forms.degenerate) return {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
    const auto [a, b, c, mean, half, s12] = shape_operator(forms);
    const double radius = elementary::hypot(half, s12);
    const bool umbilic = radius <= UMBILIC * std::abs(mean);
    const auto [sine, cosine] =
        elementary::sincos(umbilic ? 0.0 : 0.5 * elementary::atan2(s12, half));
    return {{mean + radius, mean - radius},
            {cosine / a - b * sine / (a * c), sine / c},
            {-sine / a - b * cosine / (a * c), cosine / c}};
}

}  // namespace surfmesh
