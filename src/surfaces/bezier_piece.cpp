#include "surfaces/bezier_piece.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double BEYOND = 1e-6;        // of the knots' range: how far a range may leave it
constexpr double AT_THE_KNOT = 1e-12;  // of it: an end of the range so near to a crease lies there

}  // namespace

bool split_at_knots(const SplineBasis& basis, double first, double last, Array<SpanPart>& parts) {
    parts.clear();
    const std::span<const double> knots = basis.knots();
    const std::size_t degree = basis.degree(), end = knots.size() - degree - 1;
    const double start = knots[degree], stop = knots[end], slack = BEYOND * (stop - start);
    const double period = basis.period(), near = AT_THE_KNOT * (stop - start);
    if (!(first <= last)) return false;
    if (period > 0.0 && (first < start || last > stop)) {
        const double shift = period * std::floor((0.5 * (first + last) - start) / period);
        first -= shift;
        last -= shift;
    }
    if (first < start - slack || last > stop + slack) return false;
    std::size_t span = degree;
    while (span + 1 < end && (knots[span + 1] <= first || knots[span] == knots[span + 1])) ++span;
    double from = first;
    for (;;) {
        std::size_t next = span + 1;  // the first knot of the next span, and how often it is there
        const double knot = knots[next];
        if (!(knot < last) || next >= end) {  // the last part
            parts.push_back({static_cast<std::int64_t>(span), from, last});
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
            else if (knot - from > near)
                return false;
            else
                from = knot;
        }
        if (from < knot) parts.push_back({static_cast<std::int64_t>(span), from, knot});
        if (last <= knot) return true;
        from = std::max(from, knot);
        span = next;
    }
}

void restrict_to(const SplineBasis& basis, const SpanPart& part, Homogeneous* control,
                 std::size_t stride, Homogeneous* work) {
    const std::size_t degree = basis.degree();
    const double* knots = basis.knots().data() + part.span - static_cast<std::int64_t>(degree);
    constexpr std::size_t MOST = 32;
    std::array<Homogeneous, MOST> found{};
    for (std::size_t i = 0; i <= degree; ++i) {  // the blossom of degree - i firsts and i lasts
        for (std::size_t j = 0; j <= degree; ++j) work[j] = control[j * stride];
        for (std::size_t r = 1; r <= degree; ++r) {
            const double t = r <= degree - i ? part.first : part.last;
            for (std::size_t j = degree; j >= r; --j) {
                const double a = (t - knots[j]) / (knots[j + degree + 1 - r] - knots[j]);
                for (std::size_t c = 0; c < 4; ++c)
                    work[j][c] = (1.0 - a) * work[j - 1][c] + a * work[j][c];
            }
        }
        found[i] = work[degree];
    }
    for (std::size_t i = 0; i <= degree; ++i) control[i * stride] = found[i];
}

}  // namespace surfmesh
