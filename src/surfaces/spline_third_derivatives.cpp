// Derivatives of a spline surface to the third order over cells, by the differences of the Bezier
// coefficients of each span that a cell meets; and its tangents at points, by those at a corner.
//
// A rational surface is S = A / w, with A about a point of the part so that S is small:
//
//     S^(k,l) = (A^(k,l) - sum over (i,j) != 0 of (k over i) (l over j) w^(i,j) S^(k-i,l-j)) / w
//
// Source: Piegl, Tiller, "The NURBS Book", 2nd edition, 1997, 4.4 and 5.3.
#include <algorithm>
#include <cmath>

#include "surfaces/bezier_piece.hpp"
#include "surfaces/bezier_ranges.hpp"
#include "surfaces/boxed_vectors.hpp"
#include "surfaces/spline_surface.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t HIGHEST_OF_THIRD = 25;  // degree: what CAD kernels allow
constexpr double LEAST_OF_SPAN = 0x1p-8;  // parts no narrower: third differences would be round-off
constexpr double NEAR_CREASE = 1e-12;     // of the knots' range: as near as split_at_knots says

constexpr Directions AXES = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

using DerivativeRanges = std::array<Interval, derivative_count(3)>;

constexpr std::size_t number_of(std::size_t k, std::size_t l) {
    return (k + l) * (k + l + 1) / 2 + l;
}

/// Of A / w, in the sequence of derivatives; s: the range of the quotient itself.
DerivativeRanges quotient_ranges(const DerivativeRanges& a, const DerivativeRanges& w, Interval s,
                                 std::size_t order) {
    constexpr std::array<std::array<double, 4>, 4> OVER = {
        {{1.0, 0.0, 0.0, 0.0}, {1.0, 1.0, 0.0, 0.0}, {1.0, 2.0, 1.0, 0.0}, {1.0, 3.0, 3.0, 1.0}}};
    DerivativeRanges found{};
    found[0] = s;
    for (std::size_t n = 1; n <= order; ++n)
        for (std::size_t l = 0; l <= n; ++l) {
            const std::size_t k = n - l;
            Interval sum = a[number_of(k, l)];
            for (std::size_t i = 0; i <= k; ++i)
                for (std::size_t j = 0; j <= l; ++j) {
                    if (i + j == 0) continue;
                    const Interval term =
                        outward::multiply(w[number_of(i, j)], found[number_of(k - i, l - j)]);
                    const Interval times = outward::exactly(OVER[k][i] * OVER[l][j]);
                    sum = outward::subtract(sum, outward::multiply(times, term));
                }
            found[number_of(k, l)] = outward::divide(sum, w[0]);
        }
    return found;
}

Interval& coordinate(BoxedVector& box, std::size_t axis) {
    return axis == 0 ? box.x : axis == 1 ? box.y : box.z;
}

/// A part that has a width, within the same span: of cells that have none, as along a side.
SpanPart with_width(const SplineBasis& basis, SpanPart part) {
    const double low = basis.knots()[static_cast<std::size_t>(part.span)],
                 high = basis.knots()[static_cast<std::size_t>(part.span) + 1];
    const double least = LEAST_OF_SPAN * (high - low);
    if (part.last - part.first >= least) return part;
    if (part.first + least <= high)
        part.last = part.first + least;
    else
        part.first = part.last - least;
    return part;
}

/// How often the knot at the end of a part's span is there.
std::size_t times_at_end(const SplineBasis& basis, const SpanPart& part) {
    const auto knots = basis.knots();
    const double knot = knots[static_cast<std::size_t>(part.span) + 1];
    return static_cast<std::size_t>(std::count(knots.begin(), knots.end(), knot));
}

/// May a second derivative jump before the parts; false where a first one may.
bool jumps_before(const SplineBasis& basis, const Array<SpanPart>& parts,
                  Array<std::uint8_t>& jumps) {
    jumps.clear();
    const std::span all(parts.data(), parts.size());
    for (std::size_t n = 0; n < all.size(); ++n) {
        if (all[n].after_crease) return false;
        jumps.push_back(n > 0 && times_at_end(basis, all[n - 1]) + 1 >= basis.degree() ? 1 : 0);
    }
    return true;
}

/// The polynomials of a parameter, two where it is a crease.
struct PlacesAtParameter {
    std::array<SpanPart, 2> part;
    std::array<bool, 2> from_last;  // the parameter is the part's last one
    std::size_t count = 0;

    /// From the parameter to the farther end of the span.
    void take(const SplineBasis& basis, std::int64_t span, double t) {
        const auto at = static_cast<std::size_t>(span);
        const double low = basis.knots()[at], high = basis.knots()[at + 1];
        const bool is_late = t - low > high - t;
        part[count] = {span, is_late ? low : t, is_late ? t : high, 0.0, false};
        from_last[count++] = is_late;
    }
};

PlacesAtParameter places_at(const SplineBasis& basis, double t, Interval domain) {
    PlacesAtParameter found;
    const KnotPlace place = basis.locate(t);
    found.take(basis, place.span, place.t);
    const auto knots = basis.knots();
    const std::size_t degree = basis.degree(), end = knots.size() - degree - 1;
    const double near = NEAR_CREASE * (knots[end] - knots[degree]);
    if (t - domain.lo <= near || domain.hi - t <= near) return found;
    const auto span = static_cast<std::size_t>(place.span);
    const double low = knots[span], high = knots[span + 1];
    const bool at_low = place.t - low <= near, at_high = high - place.t <= near;
    const double knot = at_low ? low : high;
    const bool at_end = knot == knots[degree] || knot == knots[end];
    const auto times = static_cast<std::size_t>(std::count(knots.begin(), knots.end(), knot));
    if (!(at_low || at_high) || (times < degree && !at_end)) return found;
    if (at_end && !(basis.period() > 0.0)) return found;
    std::size_t other = at_low ? span : span + 1;
    double there = place.t;
    if (at_end) {
        other = at_low ? end : degree;
        there += at_low ? basis.period() : -basis.period();
    }
    if (at_low)
        for (--other; other > degree && knots[other] == knots[other + 1];) --other;
    else
        while (other + 2 < end && knots[other] == knots[other + 1]) ++other;
    found.take(basis, static_cast<std::int64_t>(other), there);
    return found;
}

}  // namespace

/// What is worked in, for one part after the other.
struct SplineSurface::ThirdWork {
    Array<SpanPart> u, v;
    Array<Homogeneous> control, line;
    Array<double> numbers, weights, differences;

    explicit ThirdWork(std::size_t rows, std::size_t columns)
        : control(rows * columns),
          line(std::max(rows, columns)),
          numbers(rows * columns),
          weights(rows * columns),
          differences(2 * rows * columns) {}
};

/// Over a part, of the derivatives up to the order; at a corner of it alone where that is given.
DerivativeBoxes SplineSurface::boxes_of_part(const PartOfCell& part, const Directions& directions,
                                             int order, const BezierCorner* corner,
                                             ThirdWork& work) const {
    const std::size_t rows = u_.degree() + 1, columns = v_.degree() + 1, count = rows * columns;
    const bool rational = !weights_.empty();
    const auto& [u, v] = part;
    const double largest = coefficients(part, middle_of(part), work.control, work.line);
    const double error = 2.0 * restriction_error(u_.degree() + v_.degree(), largest);
    const std::span<const Homogeneous> control(work.control.data(), count);
    const Homogeneous& c = control[(rows / 2) * columns + columns / 2];
    const Point3 about = {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
    const double moved = rational ? error * (1.0 + norm(about)) + 4.0 * error : error;
    const std::span<double> numbers(work.numbers.data(), count),
        weights(work.weights.data(), count);
    const auto ranges_of = [&](std::span<const double> values, double off) {
        const BezierNumbers given{rows,          columns, u.last - u.first, v.last - v.first,
                                  values.data(), off};
        DerivativeRanges found{};
        derivative_ranges(given, order, corner, {work.differences.data(), 2 * count}, found);
        return found;
    };
    const std::size_t at_corner = corner == nullptr ? 0
                                                    : (corner->last_u ? count - columns : 0) +
                                                          (corner->last_v ? columns - 1 : 0);
    DerivativeRanges w{};
    double least = 1.0;
    if (rational) {
        for (std::size_t k = 0; k < count; ++k) weights[k] = control[k][3];
        least = *std::min_element(weights.begin(), weights.end());
        w = ranges_of(weights, error);
    }
    DerivativeBoxes boxes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        NumberRange quotients;
        for (std::size_t k = 0; k < count; ++k) {
            const Homogeneous& x = control[k];
            Point3 at = {x[0], x[1], x[2]};
            if (rational) at = at - x[3] * about;
            numbers[k] = dot(directions[axis], at);
            if (rational && (corner == nullptr || k == at_corner))
                quotients.take(numbers[k] / x[3]);
        }
        DerivativeRanges found = ranges_of(numbers, 4.0 * moved);
        if (rational) {
            const double off = quotient_error(4.0 * moved, error, largest, least);
            const bool is_known = off < intervals::INFINITE && w[0].lo > 0.0;
            const Interval s = is_known ? quotients.scaled(1.0, off) : UNBOUNDED;
            found = quotient_ranges(found, w, s, static_cast<std::size_t>(order));
        }
        for (std::size_t k = 0; k < found.size(); ++k) coordinate(boxes[k], axis) = found[k];
    }
    return boxes;
}

bool SplineSurface::enclose_third(const ParameterBox& cell, const Directions& directions,
                                  PartBoxes& out) const {
    if (std::max(u_.degree(), v_.degree()) > HIGHEST_OF_THIRD) return false;
    ThirdWork work(u_.degree() + 1, v_.degree() + 1);
    if (!split_at_knots(u_, cell.low.x, cell.high.x, work.u) ||
        !split_at_knots(v_, cell.low.y, cell.high.y, work.v) ||
        !jumps_before(u_, work.u, out.jumps_u) || !jumps_before(v_, work.v, out.jumps_v))
        return false;
    out.parts_u = work.u.size();
    out.parts_v = work.v.size();
    out.boxes.clear();
    for (const SpanPart& part_u : work.u)
        for (const SpanPart& part_v : work.v) {
            const SpanPart u = with_width(u_, part_u), v = with_width(v_, part_v);
            out.boxes.push_back(boxes_of_part({u, v}, directions, 3, nullptr, work));
        }
    return true;
}

bool SplineSurface::enclose_tangents(Point2 uv, TangentBoxes& out) const {
    if (std::max(u_.degree(), v_.degree()) > HIGHEST_OF_THIRD) return false;
    ThirdWork work(u_.degree() + 1, v_.degree() + 1);
    const auto places_u = places_at(u_, uv.x, {domain_.low.x, domain_.high.x});
    const auto places_v = places_at(v_, uv.y, {domain_.low.y, domain_.high.y});
    for (std::size_t i = 0; i < places_u.count; ++i)
        for (std::size_t j = 0; j < places_v.count; ++j) {
            const BezierCorner corner{places_u.from_last[i], places_v.from_last[j]};
            const DerivativeBoxes boxes =
                boxes_of_part({places_u.part[i], places_v.part[j]}, AXES, 1, &corner, work);
            const TangentBoxes found{boxes[1], boxes[2]};
            out = i + j == 0
                      ? found
                      : TangentBoxes{outward::hull(out.u, found.u), outward::hull(out.v, found.v)};
        }
    return true;
}

}  // namespace surfmesh
