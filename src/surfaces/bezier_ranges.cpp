#include "surfaces/bezier_ranges.hpp"

#include "surfaces/surface.hpp"

namespace surfmesh {
namespace {

/// A derivative along u or v that no width goes with is multiplied by a width of 0 in the end.
double per(double width) { return width > 0.0 ? 1.0 / width : 0.0; }

}  // namespace

Interval value_range(const BezierNumbers& c) {
    NumberRange found;
    for (std::size_t i = 0; i < c.rows * c.columns; ++i) found.take(c.values[i]);
    return found.scaled(1.0, c.error);
}

Interval derivative_range(const BezierNumbers& c, std::size_t k, std::size_t l) {
    NumberRange found;
    const auto along_u = [&](std::size_t i, std::size_t j) {
        if (k == 0) return c.at(i, j);
        if (k == 1) return c.at(i + 1, j) - c.at(i, j);
        return (c.at(i + 2, j) - c.at(i + 1, j)) - (c.at(i + 1, j) - c.at(i, j));
    };
    for (std::size_t i = 0; i + k < c.rows; ++i)
        for (std::size_t j = 0; j + l < c.columns; ++j)
            found.take(l == 0   ? along_u(i, j)
                       : l == 1 ? along_u(i, j + 1) - along_u(i, j)
                                : (along_u(i, j + 2) - along_u(i, j + 1)) -
                                      (along_u(i, j + 1) - along_u(i, j)));
    const auto p = static_cast<double>(c.rows - 1), q = static_cast<double>(c.columns - 1);
    double factor = 1.0;
    if (k > 0) factor *= p * per(c.width_u);
    if (k > 1) factor *= (p - 1.0) * per(c.width_u);
    if (l > 0) factor *= q * per(c.width_v);
    if (l > 1) factor *= (q - 1.0) * per(c.width_v);
    return found.scaled(factor, 4.0 * c.error);  // at most four ends, of a second difference
}

void derivative_ranges(const BezierNumbers& c, int order, const BezierCorner* corner,
                       std::span<double> work, std::span<Interval> out) {
    const std::size_t most = static_cast<std::size_t>(order), count = c.rows * c.columns;
    const auto by_v = work.first(count), by_both = work.last(count);
    std::copy_n(c.values, count, by_v.begin());
    double factor_v = 1.0;
    for (std::size_t l = 0; l <= most; ++l) {
        std::copy(by_v.begin(), by_v.end(), by_both.begin());
        double factor = factor_v;
        for (std::size_t k = 0; k + l <= most; ++k) {
            NumberRange found;
            const std::size_t rows = c.rows > k ? c.rows - k : 0,
                              columns = c.columns > l ? c.columns - l : 0;
            const bool at_corner = corner != nullptr && rows > 0 && columns > 0;
            if (at_corner)
                found.take(by_both[(corner->last_u ? rows - 1 : 0) * c.columns +
                                   (corner->last_v ? columns - 1 : 0)]);
            for (std::size_t i = 0; i < rows && !at_corner; ++i)
                for (std::size_t j = 0; j < columns; ++j) found.take(by_both[i * c.columns + j]);
            // the errors of 2^(k + l) coefficients, and as much for the rounding of differences
            const double error = static_cast<double>(std::size_t{2} << (k + l)) * c.error;
            out[derivative_number(k, l)] = found.scaled(factor, error);
            factor *= static_cast<double>(c.rows - 1 - std::min(k, c.rows - 1)) * per(c.width_u);
            for (std::size_t i = 0; i + 1 < rows; ++i)
                for (std::size_t j = 0; j < columns; ++j)
                    by_both[i * c.columns + j] =
                        by_both[(i + 1) * c.columns + j] - by_both[i * c.columns + j];
        }
        factor_v *=
            static_cast<double>(c.columns - 1 - std::min(l, c.columns - 1)) * per(c.width_v);
        for (std::size_t i = 0; i < c.rows; ++i)
            for (std::size_t j = 0; j + l + 1 < c.columns; ++j)
                by_v[i * c.columns + j] = by_v[i * c.columns + j + 1] - by_v[i * c.columns + j];
    }
}

Interval quotient_slope(Interval a_u, Interval w_u, Interval s, Interval w) {
    using namespace outward;
    return divide(subtract(a_u, multiply(w_u, s)), w);
}

double quotient_error(double error_of_a, double error_of_w, double largest, double least_weight) {
    if (!(least_weight > 2.0 * error_of_w)) return intervals::INFINITE;
    return 4.0 * (error_of_a + error_of_w * largest / least_weight) / least_weight;
}

}  // namespace surfmesh
