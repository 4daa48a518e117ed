#include "surfaces/bezier_piece.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfmesh {
namespace {

// of the outermost span: how far a range may leave it, so that 1 + 2 of it to the power of the
// degrees is within the margin of ``restriction_error``
constexpr double BEYOND = 0x1p-8;
constexpr double AT_THE_KNOT = 1e-12;  // of the knots' range: an end so near to a crease lies there
constexpr double NARROW = 0x1p-12;     // of a span: differences of coefficients would be round-off

struct KnotRange {
    double first, last;
};

/// A part, made wider within its span if it is narrow, on the side where it does not end in a knot.
SpanPart part_of(std::span<const double> knots, std::size_t span, KnotRange part,
                 bool after_crease) {
    const double low = knots[span], high = knots[span + 1], least = NARROW * (high - low);
    auto [first, last] = part;
    if (const double width = last - first; width > 0.0 && width < least) {
        if (last >= high)
            first = std::max(std::min(first, low), last - least);
        else
            last = std::min(high, first + least);
    }
    return {static_cast<std::int64_t>(span), first, last, part.last - part.first, after_crease};
}

/// The parts of a range between two knots; false at a jump.
bool split_within(const SplineBasis& basis, KnotRange range, bool after_crease,
                  Array<SpanPart>& parts) {
    const std::span<const double> knots = basis.knots();
    const std::size_t degree = basis.degree(), end = knots.size() - degree - 1;
    const double near = AT_THE_KNOT * (knots[end] - knots[degree]);
    auto [from, last] = range;
    std::size_t span = degree;
    while (span + 1 < end && (knots[span + 1] <= from || knots[span] == knots[span + 1])) ++span;
    for (;;) {
        std::size_t next = span + 1;  // the first knot of the next span, and how often it is there
        const double knot = knots[next];
        if (!(knot < last) || next >= end) {  // the last part
            parts.push_back(part_of(knots, span, {from, last}, after_crease));
            return true;
        }
        std::size_t count = 1;
        while (next + 1 < end && knots[next + 1] == knot) {
            ++next;
            ++count;
        }
        if (count >= degree) {
            if (last - knot <= near)
                last = std::max(from, knot);
            else if (knot - from <= near)
                from = knot;
            else if (count > degree)
                return false;
        }
        if (from < knot) {
            parts.push_back(part_of(knots, span, {from, knot}, after_crease));
            after_crease = count >= degree;
        }
        if (last <= knot) return true;
        from = std::max(from, knot);
        span = next;
    }
}

/// May the polynomials of the outermost spans go on so far?
bool is_near_knots(const SplineBasis& basis, KnotRange range) {
    const std::span<const double> knots = basis.knots();
    const std::size_t degree = basis.degree(), end = knots.size() - degree - 1;
    std::size_t first = degree, last = end - 1;
    while (first + 1 < end && knots[first] == knots[first + 1]) ++first;
    while (last > degree && knots[last] == knots[last + 1]) --last;
    return range.first >= knots[degree] - BEYOND * (knots[first + 1] - knots[first]) &&
           range.last <= knots[end] + BEYOND * (knots[last + 1] - knots[last]);
}

}  // namespace

bool split_at_knots(const SplineBasis& basis, double first, double last, Array<SpanPart>& parts) {
    parts.clear();
    const std::span<const double> knots = basis.knots();
    const std::size_t degree = basis.degree(), end = knots.size() - degree - 1;
    const double start = knots[degree], stop = knots[end], near = AT_THE_KNOT * (stop - start);
    const double period = basis.period();
    if (!(first <= last)) return false;
    if (!(period > 0.0) || (first >= start && last <= stop))
        return is_near_knots(basis, {first, last}) &&
               split_within(basis, {first, last}, false, parts);
    const double shift = period * std::floor((0.5 * (first + last) - start) / period);
    first -= shift;
    last -= shift;
    const bool before = first<start - near, after = last> stop + near;
    if (before && after) return false;
    const KnotRange inside = {std::max(first, start), std::min(last, stop)};
    if (before)
        return first + period > start &&
               split_within(basis, {first + period, stop}, false, parts) &&
               split_within(basis, inside, true, parts);
    return split_within(basis, inside, false, parts) &&
           (!after ||
            (last - period < stop && split_within(basis, {start, last - period}, true, parts)));
}

// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): what is read is set
Restriction::Restriction(const SplineBasis& basis, const SpanPart& part) : degree_(basis.degree()) {
    const auto first = static_cast<std::size_t>(part.span) - degree_;
    const std::span<const double> knots = basis.knots().subspan(first);
    set_steps(knots, part.first, to_first_);
    set_steps(knots, part.last, to_last_);
}

void Restriction::set_steps(std::span<const double> knots, double t, Steps& steps) const {
    std::size_t at = 0;
    for (std::size_t r = 1; r <= degree_; ++r)
        for (std::size_t j = r; j <= degree_; ++j)
            steps[at++] = (t - knots[j]) / (knots[j + degree_ + 1 - r] - knots[j]);
}

void Restriction::take_step(const Steps& steps, std::size_t r, Homogeneous* points) const {
    const double* weights = steps.data() + first_of(r);
    for (std::size_t j = degree_; j >= r; --j) {
        const double a = weights[j - r];
        for (std::size_t c = 0; c < 4; ++c)
            points[j][c] = (1.0 - a) * points[j - 1][c] + a * points[j][c];
    }
}

/// Coefficient i is the blossom of degree - i firsts and i lasts, which begins with the steps to the
/// first that those after it begin with as well.
void Restriction::apply(Homogeneous* control, std::size_t stride) const {
    std::array<Homogeneous, HIGHEST_DEGREE + 1> points, work;  // NOLINT: as above
    for (std::size_t j = 0; j <= degree_; ++j) points[j] = control[j * stride];
    for (std::size_t taken = 0; taken <= degree_; ++taken) {
        if (taken > 0) take_step(to_first_, taken, points.data());
        std::copy(points.begin() + static_cast<std::ptrdiff_t>(taken),
                  points.begin() + static_cast<std::ptrdiff_t>(degree_ + 1),
                  work.begin() + static_cast<std::ptrdiff_t>(taken));
        for (std::size_t r = taken + 1; r <= degree_; ++r) take_step(to_last_, r, work.data());
        control[(degree_ - taken) * stride] = work[degree_];
    }
}

/// Both begin with all steps but one to the end.
std::array<Homogeneous, 2> Restriction::at_end(const Homogeneous* control, std::size_t stride,
                                               bool at_last) const {
    std::array<Homogeneous, HIGHEST_DEGREE + 1> points;  // NOLINT: as above
    for (std::size_t j = 0; j <= degree_; ++j) points[j] = control[j * stride];
    for (std::size_t r = 1; r < degree_; ++r)
        take_step(at_last ? to_last_ : to_first_, r, points.data());
    const Homogeneous last = points[degree_];
    take_step(to_first_, degree_, points.data());
    const Homogeneous first = std::exchange(points[degree_], last);
    take_step(to_last_, degree_, points.data());
    return {first, points[degree_]};
}

}  // namespace surfmesh
