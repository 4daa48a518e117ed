// Lines and conics along a vector: their ranges, and those of their derivatives.
#include <cmath>

#include "elementary_functions/hyperbolic.hpp"
#include "surfaces/elementary_curves.hpp"
#include "surfaces/enclosure.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr double ROUNDING = 0x1p-48;  // more than any of the short sums below, of their terms

double size_of(Point3 a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); }

Interval wider(Interval a, double margin) { return {a.lo - margin, a.hi + margin}; }

/// a f + b g, both positive where it matters, for ranges of f and g.
Interval combined(double a, Interval f, double b, Interval g) {
    using namespace outward;
    return add(multiply(exactly(a), f), multiply(exactly(b), g));
}

}  // namespace

bool Line::enclose_along(Interval t, Point3 w, Point3 about, CurveAlong& out) const {
    using namespace outward;
    const double slope = dot(w, direction_), start = dot(w, origin_ - about);
    const double margin = ROUNDING * size_of(w);
    const Interval rate = wider(exactly(slope), margin * size_of(direction_));
    out = {{add(wider(exactly(start), margin * (size_of(origin_) + size_of(about))),
                multiply(rate, t)),
            rate, exactly(0.0)}};
    return true;
}

bool Conic::enclose_along(Interval t, Point3 w, Point3 about, CurveAlong& out) const {
    using namespace outward;
    const auto& [origin, x, y] = axes_;
    const double size = size_of(w) * (size_of(x) + size_of(y));
    const double a = dot(w, x), b = dot(w, y);
    const Interval start = wider(exactly(dot(w, origin - about)),
                                 ROUNDING * size_of(w) * (size_of(origin) + size_of(about)));
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

}  // namespace surfmesh
