#include "surfaces/offset_curve.hpp"

#include <algorithm>

namespace surfmesh {
namespace {

constexpr double CUSP = 1e-12;       // |m| over the largest |m| asked for at a time: no tangent
constexpr double CUSP_NUDGE = 1e-8;  // of the part in use: how far from it the direction is taken

/// e = m / |m| and its derivatives in place of those of m, by the product rule.
void make_unit(std::span<Point3> m, std::span<double> length) {
    const double safe = norm(m[0]);
    length[0] = safe > 0.0 ? safe : 1.0;
    const auto divided = [&](Point3 a) {
        return Point3{a.x / length[0], a.y / length[0], a.z / length[0]};
    };
    // all lengths first, as they need m itself: s s = m . m, k times
    for (std::size_t k = 1; k < m.size(); ++k) {
        double square = 0.0, inner = 0.0, binomial = 1.0;  // k over j
        for (std::size_t j = 0; j <= k; ++j) {
            square += binomial * dot(m[j], m[k - j]);
            if (0 < j && j < k) inner += binomial * length[j] * length[k - j];
            binomial = binomial * static_cast<double>(k - j) / static_cast<double>(j + 1);
        }
        length[k] = (square - inner) / (2.0 * length[0]);
    }
    m[0] = divided(m[0]);
    for (std::size_t k = 1; k < m.size(); ++k) {  // s e = m, k times
        Point3 rest{0.0, 0.0, 0.0};
        double binomial = 1.0;
        for (std::size_t j = 1; j <= k; ++j) {
            binomial = binomial * static_cast<double>(k - j + 1) / static_cast<double>(j);
            rest = rest + binomial * length[j] * m[k - j];
        }
        m[k] = divided(m[k] - rest);
    }
}

}  // namespace

/// The vector that tangents are crossed with: in the plane, the normal of the plane.
Point3 OffsetCurve::side() const { return dimension() == 2 ? Point3{0.0, 0.0, 1.0} : direction_; }

/// A parameter near one where there is no tangent, inwards from the nearer end.
double OffsetCurve::beside_cusp(double t) const {
    if (!limits_) return t + CUSP_NUDGE;
    const auto [first, last] = *limits_;
    const double step = CUSP_NUDGE * (last - first);
    return t > 0.5 * (first + last) ? t - step : t + step;
}

void OffsetCurve::evaluate(std::span<const double> t, int order, std::span<Point3> out) const {
    const std::size_t count = t.size();
    const CurveValues c(*curve_, t, order + 1);
    double longest = 0.0;
    for (const Point3 tangent : c[1]) longest = std::max(longest, norm(cross(tangent, side())));
    const auto terms = static_cast<std::size_t>(order + 1);
    Array<Point3> m(terms);
    Array<double> lengths(terms);
    for (std::size_t i = 0; i < count; ++i) {
        for (int k = 0; k <= order; ++k) m[k] = cross(c[k + 1][i], side());
        if (!(norm(m[0]) > CUSP * longest)) {
            const double near = beside_cusp(t[i]);
            const CurveValues beside(*curve_, {&near, 1}, order + 1);
            for (int k = 0; k <= order; ++k) m[k] = cross(beside[k + 1][0], side());
        }
        make_unit({m.data(), terms}, {lengths.data(), terms});
        for (int k = 0; k <= order; ++k)
            out[static_cast<std::size_t>(k) * count + i] = c[k][i] + distance_ * m[k];
    }
}

}  // namespace surfmesh
