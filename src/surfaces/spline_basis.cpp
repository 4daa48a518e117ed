#include "surfaces/spline_basis.hpp"

#include <cmath>

namespace surfmesh {
namespace {

// of the knots' range: an end of the part in use this near to a knot is that knot
constexpr double SNAP = 1e-12;

// Above the diagonal of the table is table[r, j] = N_{span-j+r} of degree j, below it table[j, r]
// = the knots' distance that the function of degree j is divided by. No such distance is less
// than the span, which is not empty. knots: those behind the span.
template <class Number>
void take_derivatives(const double* knots, std::int64_t degree, Number t, int order, Number* table,
                      Number* out) {
    const std::int64_t columns = degree + 1;
    table[0] = Number{} + 1.0;
    for (std::int64_t j = 1; j <= degree; ++j) {
        Number saved{};
        for (std::int64_t r = 0; r < j; ++r) {
            const double low = knots[r - j], high = knots[r];
            const Number width = Number{} + (high - low);
            table[j * columns + r] = width;
            const Number part = table[r * columns + j - 1] / width;
            table[r * columns + j] = saved + (high - t) * part;
            saved = (t - low) * part;
        }
        table[j * columns + j] = saved;
    }
    for (std::int64_t r = 0; r < columns; ++r) out[r] = table[r * columns + degree];
    for (int k = 1; k <= order; ++k) {
        Number* row = out + k * columns;
        if (k > degree) {
            for (std::int64_t r = 0; r < columns; ++r) row[r] = Number{};
            continue;
        }
        // N'_i of degree q = q (N_i / width_i - N_{i+1} / width_{i+1}), both of degree q - 1
        for (std::int64_t r = 0; r <= degree - k; ++r) row[r] = table[r * columns + degree - k];
        for (std::int64_t q = degree - k + 1; q <= degree; ++q) {
            Number left{};
            for (std::int64_t r = 0; r < q; ++r) {
                const Number right = row[r] / table[q * columns + r];
                row[r] = static_cast<double>(q) * (left - right);
                left = right;
            }
            row[q] = static_cast<double>(q) * left;
        }
    }
}

}  // namespace

/// The span of t by bisection; beyond the ends the outermost span that is not empty.
std::int64_t SplineBasis::last_knot_not_above(double t) const {
    const std::int64_t first = degree_,
                       last = static_cast<std::int64_t>(knots_.size()) - degree_ - 2;
    std::int64_t low = first, high = last;
    while (low < high) {
        const std::int64_t middle = (low + high + 1) >> 1;
        if (knots_[middle] <= t)
            low = middle;
        else
            high = middle - 1;
    }
    std::int64_t span = low;
    while (span > first && knots_[span] == knots_[span + 1]) --span;
    while (span < last && knots_[span] == knots_[span + 1]) ++span;
    return span;
}

KnotPlace SplineBasis::locate(double t) const {
    const double start = knots_[degree_];
    const double end = knots_[static_cast<std::int64_t>(knots_.size()) - degree_ - 1];
    const double tiny = SNAP * (end - start);
    const auto& [first, last, period] = limits_;
    double local = t;
    if (period > 0.0 && (t < start || t > end))
        local = t - period * std::floor((t - start) / period);
    std::int64_t span = last_knot_not_above(local);
    if (std::abs(t - last) <= tiny && local - knots_[span] <= tiny) {
        if (span > degree_ && knots_[span] > start) {
            --span;
            while (span > degree_ && knots_[span] == knots_[span + 1]) --span;
        } else if (period > 0.0) {
            local += period;
            span = last_knot_not_above(end);
        }
    } else if (std::abs(t - first) <= tiny && knots_[span + 1] - local <= tiny) {
        if (knots_[span + 1] < end) {
            span = last_knot_not_above(knots_[span + 1]);
        } else if (period > 0.0) {
            local -= period;
            span = last_knot_not_above(start);
        }
    }
    return {span, local};
}

void SplineBasis::derivatives(KnotPlace place, int order, std::span<double> table,
                              std::span<double> out) const {
    take_derivatives(knots_.data() + place.span + 1, degree_, place.t, order, table.data(),
                     out.data());
}

void SplineBasis::derivatives(std::int64_t span, TwoNumbers t, int order,
                              std::span<TwoNumbers> table, std::span<TwoNumbers> out) const {
    take_derivatives(knots_.data() + span + 1, degree_, t, order, table.data(), out.data());
}

}  // namespace surfmesh
