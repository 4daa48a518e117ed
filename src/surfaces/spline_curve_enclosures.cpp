// How spline curves bend along a vector, by the Bezier coefficients of each span that a range meets.
//
// A rational curve is S = A / w, with A about a point of the span so that S is small:
//
//     S' = (A' - w' S) / w        S'' = (A'' - 2 w' S' - w'' S) / w
//
// Source: Piegl, Tiller, "The NURBS Book", 2nd edition, 1997, 4.2 and 5.3.
#include <algorithm>
#include <cmath>

#include "surfaces/bezier_ranges.hpp"
#include "surfaces/boxed_vectors.hpp"
#include "surfaces/spline_creases.hpp"
#include "surfaces/spline_curve.hpp"

namespace surfmesh {
namespace {

// parts so narrow for their range are counted by how much the first derivative changes over them
constexpr double THIN_OF_RANGE = 0x1p-10;
constexpr std::array<Interval, 3> NO_RANGES = {UNBOUNDED, UNBOUNDED, UNBOUNDED};

/// Along a vector of size 1 at most, of coefficients about a point.
std::array<Interval, 3> ranges_along(std::span<const Homogeneous> control, Point3 w, double width,
                                     double error, double largest, bool rational) {
    using namespace outward;
    Array<double> along, weights;
    NumberRange quotients;
    for (const Homogeneous& c : control) {
        along.push_back(w.x * c[0] + w.y * c[1] + w.z * c[2]);
        weights.push_back(c[3]);
        if (rational) quotients.take(along.back() / c[3]);
    }
    const BezierNumbers a{control.size(), 1, width, 0.0, along.data(), 4.0 * error};
    const Interval a_1 = derivative_range(a, 1, 0), a_2 = derivative_range(a, 2, 0);
    if (!rational) return {value_range(a), a_1, a_2};
    const BezierNumbers b{control.size(), 1, width, 0.0, weights.data(), error};
    const double least = *std::min_element(weights.begin(), weights.end());
    const double off = quotient_error(a.error, error, largest, least);
    const Interval weight = value_range(b), w_1 = derivative_range(b, 1, 0);
    if (!(off < intervals::INFINITE) || !(weight.lo > 0.0)) return NO_RANGES;
    const Interval s = quotients.scaled(1.0, off), s_1 = quotient_slope(a_1, w_1, s, weight);
    const Interval twice{2.0 * w_1.lo, 2.0 * w_1.hi};
    const Interval rest = subtract(a_2, multiply(derivative_range(b, 2, 0), s));
    return {s, s_1, divide(subtract(rest, multiply(twice, s_1)), weight)};
}

}  // namespace

/// Bezier coefficients over a part, about a point; the largest of what they are made of.
double SplineCurve::coefficients(const SpanPart& part, Point3 about,
                                 std::span<Homogeneous> control) const {
    const std::size_t degree = basis_.degree();
    double largest = 0.0;
    for (std::size_t i = 0; i <= degree; ++i) {
        const std::int64_t from = part.span - static_cast<std::int64_t>(degree - i);
        const double w = weights_.empty() ? 1.0 : weights_[from];
        const Point3 x = w * (control_[from] - about);
        control[i] = {x.x, x.y, x.z, w};
        largest = std::max(largest, norm_1(x) + (weights_.empty() ? 0.0 : w));
    }
    Restriction(basis_, part).apply(control.data(), 1);
    return largest;
}

bool SplineCurve::enclose_along(Interval t, Point3 w, Point3 about, CurveAlong& out) const {
    using namespace outward;
    Array<SpanPart> parts;
    const std::size_t degree = basis_.degree();
    if (degree > HIGHEST_DEGREE || !split_at_knots(basis_, t.lo, t.hi, parts)) return false;
    const double size = norm_1(w);
    const Point3 unit = size > 0.0 ? (1.0 / size) * w : w;
    Array<Homogeneous> control(degree + 1), before(degree + 1);
    out = CurveAlong{};
    double whole = 0.0;
    for (const SpanPart& part : parts) whole += part.width;
    bool is_first = true;
    for (std::size_t n = 0; n < parts.size(); ++n) {
        const SpanPart& part = parts.data()[n];
        const Point3 middle = control_[part.span - static_cast<std::int64_t>(degree / 2)];
        const double largest = coefficients(part, middle, {control.data(), degree + 1});
        const double error = 2.0 * restriction_error(degree, largest);
        std::array<Interval, 3> found =
            ranges_along({control.data(), degree + 1}, unit, part.last - part.first, error, largest,
                         !weights_.empty());
        for (Interval& range : found) range = widened(multiply(exactly(size), range), 8.0);
        found[0] = add(found[0], along_between(w, about, middle));
        for (std::size_t k = 0; k < 2; ++k) out[k] = n == 0 ? found[k] : hull(out[k], found[k]);
        if (part.width < THIN_OF_RANGE * whole) {
            out.jump += above(part.width * magnitude(found[2])) * (1.0 + 8.0 * ULP);
        } else {
            out[2] = is_first ? found[2] : hull(out[2], found[2]);
            is_first = false;
        }
        if (!part.after_crease) continue;
        const SpanPart& last = parts.data()[n - 1];
        const double most =
            std::max(largest, coefficients(last, middle, {before.data(), degree + 1}));
        const CreaseShape shape{
            degree, 1, 1, 1, !weights_.empty(), 2.0 * restriction_error(degree, most)};
        const auto jumps = crease_jumps({{before.data(), degree + 1}, last.last - last.first},
                                        {{control.data(), degree + 1}, part.last - part.first},
                                        shape, {unit, unit, unit});
        out.jump += jumps[0] * size * (1.0 + 8.0 * ULP);
    }
    return true;
}

}  // namespace surfmesh
