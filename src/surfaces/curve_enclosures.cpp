// Lines, conics and spline curves along a vector: their ranges, and those of their derivatives.
#include <algorithm>
#include <cmath>

#include "elementary_functions/hyperbolic.hpp"
#include "surfaces/bezier_piece.hpp"
#include "surfaces/elementary_curves.hpp"
#include "surfaces/enclosure.hpp"
#include "surfaces/outward.hpp"
#include "surfaces/spline_curve.hpp"

namespace surfmesh {
namespace {

constexpr double ROUNDING = 0x1p-48;        // more than any of the short sums below, of their terms
constexpr std::size_t HIGHEST_DEGREE = 25;  // degree

double size_of(Point3 a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); }

Interval wider(Interval a, double margin) { return {a.lo - margin, a.hi + margin}; }

/// a f + b g, both positive where it matters, for ranges of f and g.
Interval combined(double a, Interval f, double b, Interval g) {
    using namespace outward;
    return add(multiply(exactly(a), f), multiply(exactly(b), g));
}

}  // namespace

bool Line::enclose_along(Interval t, Point3 w, Point3 about, std::array<Interval, 3>& out) const {
    using namespace outward;
    const double slope = dot(w, direction_), start = dot(w, origin_ - about);
    const double margin = ROUNDING * size_of(w);
    const Interval rate = wider(exactly(slope), margin * size_of(direction_));
    out = {
        add(wider(exactly(start), margin * (size_of(origin_) + size_of(about))), multiply(rate, t)),
        rate, exactly(0.0)};
    return true;
}

bool Conic::enclose_along(Interval t, Point3 w, Point3 about, std::array<Interval, 3>& out) const {
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
        out = {add(start, add(multiply(i, multiply(square, curved)), multiply(j, t))),
               add(multiply(i, multiply(t, twice)), j), multiply(i, twice)};
        return true;
    }
    const double A = a * major_, B = b * minor_;
    const double rounding = ROUNDING * size * (std::abs(major_) + std::abs(minor_));
    if (kind_ == ConicKind::ELLIPSE) {
        out = {add(start, wider(wave_range(A, B, t), rounding)),
               wider(wave_range(B, -A, t), rounding), wider(wave_range(-A, -B, t), rounding)};
        return true;
    }
    const Interval cosh = widened(intervals::cosh(t), 3.0);
    const Interval sinh = widened(intervals::increasing(t, elementary::sinh), 3.0);
    const Interval value = wider(combined(A, cosh, B, sinh), rounding * cosh.hi);
    out = {add(start, value), wider(combined(A, sinh, B, cosh), rounding * cosh.hi), value};
    return true;
}

bool SplineCurve::enclose_along(Interval t, Point3 w, Point3 about,
                                std::array<Interval, 3>& out) const {
    using namespace outward;
    Array<SpanPart> parts;
    const std::size_t degree = basis_.degree();
    if (degree > HIGHEST_DEGREE || !weights_.empty() || !split_at_knots(basis_, t.lo, t.hi, parts))
        return false;
    Array<Homogeneous> control(degree + 1), line(degree + 1);
    bool first = true;
    for (const SpanPart& part : parts) {
        double largest = 0.0;
        for (std::size_t i = 0; i <= degree; ++i) {
            const Point3& p = control_[part.span - static_cast<std::int64_t>(degree - i)];
            const Point3 x = p - about;
            control[i] = {dot(w, x), 0.0, 0.0, 1.0};
            largest = std::max(largest, size_of(w) * size_of(x));
        }
        restrict_to(basis_, part, control.data(), 1, line.data());
        const double error = 2.0 * restriction_error(degree, largest);
        const double width = part.last - part.first, rate = width > 0.0 ? 1.0 / width : 0.0;
        std::array<Interval, 3> found = {
            {{INFINITY, -INFINITY}, {INFINITY, -INFINITY}, {INFINITY, -INFINITY}}};
        const auto take = [&](std::size_t k, double x, double margin) {
            found[k] = {std::min(found[k].lo, x - margin), std::max(found[k].hi, x + margin)};
        };
        const auto p = static_cast<double>(degree);
        for (std::size_t i = 0; i <= degree; ++i) {
            const double c0 = control[i][0];
            take(0, c0, error);
            if (i + 1 > degree) continue;
            const double c1 = control[i + 1][0];
            take(1, (c1 - c0) * (p * rate), 3.0 * error * (p * rate));
            if (i + 2 > degree) continue;
            const double c2 = control[i + 2][0], factor = p * (p - 1.0) * rate * rate;
            take(2, ((c2 - c1) - (c1 - c0)) * factor, 6.0 * error * factor);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(found[k].lo <= found[k].hi)) found[k] = {0.0, 0.0};  // above the degree
            out[k] = first ? found[k] : hull(out[k], found[k]);
        }
        first = false;
    }
    for (Interval& range : out) range = widened(range, 8.0);
    return true;
}

}  // namespace surfmesh
