// Lines and conics along a vector: their ranges, and those of their derivatives.
#include <cmath>

#include "elementary_functions/hyperbolic.hpp"
#include "surfaces/boxed_vectors.hpp"
#include "surfaces/elementary_curves.hpp"

namespace surfmesh {
namespace {

constexpr double ROUNDING = 0x1p-48;  // more than any of the short sums below, of their terms

Interval wider(Interval a, double margin) { return {a.lo - margin, a.hi + margin}; }

/// a f + b g, both positive where it matters, for ranges of f and g.
Interval combined(double a, Interval f, double b, Interval g) {
    using namespace outward;
    return add(multiply(exactly(a), f), multiply(exactly(b), g));
}

/// Of a curve without knots: its third derivative is the first one times a factor.
bool boxes_without_knots(const Curve& curve, Interval t, const Directions& directions, Point3 about,
                         double third_over_first, CurveParts& out) {
    std::array<CurveAlong, 3> c;
    for (std::size_t k = 0; k < 3; ++k)
        if (!curve.enclose_along(t, directions[k], about, c[k])) return false;
    const auto box = [&](std::size_t order) {
        return BoxedVector{c[0][order], c[1][order], c[2][order]};
    };
    out.boxes.clear();
    out.boxes.push_back(
        {box(0), box(1), box(2), outward::multiply(outward::exactly(third_over_first), box(1))});
    out.jumps.clear();
    out.jumps.push_back(0);
    return true;
}

bool tangent_without_knots(const Curve& curve, double t, BoxedVector& out) {
    CurveParts found;
    if (!boxes_without_knots(curve, {t, t}, AXES, {0.0, 0.0, 0.0}, 0.0, found)) return false;
    out = found.boxes.data()[0][1];
    return true;
}

}  // namespace

bool Line::enclose_along(Interval t, Point3 w, Point3 about, CurveAlong& out) const {
    using namespace outward;
    const Interval rate =
        wider(exactly(dot(w, direction_)), ROUNDING * norm_1(w) * norm_1(direction_));
    out = {{add(along_between(w, about, origin_), multiply(rate, t)), rate, exactly(0.0)}};
    return true;
}

bool Conic::enclose_along(Interval t, Point3 w, Point3 about, CurveAlong& out) const {
    using namespace outward;
    const auto& [origin, x, y] = axes_;
    const double size = norm_1(w) * (norm_1(x) + norm_1(y));
    const double a = dot(w, x), b = dot(w, y);
    const Interval start = along_between(w, about, origin);
    if (kind_ == ConicKind::PARABOLA) {
        const double rounding = ROUNDING * size;
        const Interval i = wider(exactly(a), rounding), j = wider(exactly(b), rounding);
        const Interval curved = divide(exactly(1.0), exactly(4.0 * major_));
        const Interval square = rounded(intervals::integer_power(t, 2));
        const Interval twice = multiply(exactly(2.0), curved);
        out = {{add(start, add(multiply(i, multiply(square, curved)), multiply(j, t))),
                add(multiply(i, multiply(t, twice)), j), multiply(i, twice)}};
        return true;
    }
    const double A = a * major_, B = b * minor_;
    const double rounding = ROUNDING * size * (std::abs(major_) + std::abs(minor_));
    if (kind_ == ConicKind::ELLIPSE) {
        out = {{add(start, wider(wave_range(A, B, t), rounding)),
                wider(wave_range(B, -A, t), rounding), wider(wave_range(-A, -B, t), rounding)}};
        return true;
    }
    const Interval cosh = widened(intervals::cosh(t), 3.0);
    const Interval sinh = widened(intervals::increasing(t, elementary::sinh), 3.0);
    const Interval value = wider(combined(A, cosh, B, sinh), rounding * cosh.hi);
    out = {{add(start, value), wider(combined(A, sinh, B, cosh), rounding * cosh.hi), value}};
    return true;
}

bool Line::enclose_third(Interval t, const Directions& directions, Point3 about,
                         CurveParts& out) const {
    return boxes_without_knots(*this, t, directions, about, 0.0, out);
}

bool Line::enclose_tangent(double t, BoxedVector& out) const {
    return tangent_without_knots(*this, t, out);
}

bool Conic::enclose_third(Interval t, const Directions& directions, Point3 about,
                          CurveParts& out) const {
    const double third_over_first = kind_ == ConicKind::ELLIPSE     ? -1.0
                                    : kind_ == ConicKind::HYPERBOLA ? 1.0
                                                                    : 0.0;
    return boxes_without_knots(*this, t, directions, about, third_over_first, out);
}

bool Conic::enclose_tangent(double t, BoxedVector& out) const {
    return tangent_without_knots(*this, t, out);
}

}  // namespace surfmesh
