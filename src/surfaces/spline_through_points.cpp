#include "surfaces/spline_through_points.hpp"

#include <algorithm>
#include <limits>

#include "surfaces/spline_basis.hpp"

namespace surfmesh {
namespace {

constexpr double NO_LIMIT = std::numeric_limits<double>::quiet_NaN();

/// Rows of a matrix with ``width`` diagonals on either side: entry (i, j) at j - i + width.
struct Band {
    std::size_t rows, width;
    Array<double> entries;

    Band(std::size_t rows, std::size_t width)
        : rows(rows), width(width), entries(rows * (2 * width + 1), 0.0) {}
    double& at(std::size_t i, std::size_t j) {
        return entries[static_cast<std::ptrdiff_t>(i * (2 * width + 1) + j + width - i)];
    }
    [[nodiscard]] std::size_t after(std::size_t i) const { return std::min(i + width + 1, rows); }
};

Array<double> knots_beside(std::span<const double> places, std::size_t degree) {
    const std::size_t left_out = (degree + 1) / 2;
    Array<double> knots(degree + 1, places.front());
    for (std::size_t k = left_out; k + left_out < places.size(); ++k) knots.push_back(places[k]);
    for (std::size_t k = 0; k <= degree; ++k) knots.push_back(places.back());
    return knots;
}

/// What each function is at each place.
Band collocation(const SplineBasis& basis, std::span<const double> places) {
    const std::size_t degree = basis.degree();
    Band band(places.size(), degree);
    SplineFunctions functions(degree, 0);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const KnotPlace place = basis.locate(places[i]);
        functions.evaluate(basis, place);
        const auto first = static_cast<std::size_t>(place.span) - degree;
        for (std::size_t r = 0; r <= degree; ++r) band.at(i, first + r) = functions[0][r];
    }
    return band;
}

/// The right side (rows, dimension) becomes the solution; the matrix is used up.
void solve(Band& matrix, std::span<double> right, std::size_t dimension) {
    const std::size_t rows = matrix.rows;
    for (std::size_t j = 0; j < rows; ++j) {
        for (std::size_t i = j + 1; i < matrix.after(j); ++i) {
            const double factor = matrix.at(i, j) / matrix.at(j, j);
            if (factor == 0.0) continue;
            for (std::size_t k = j; k < matrix.after(j); ++k)
                matrix.at(i, k) -= factor * matrix.at(j, k);
            for (std::size_t d = 0; d < dimension; ++d)
                right[i * dimension + d] -= factor * right[j * dimension + d];
        }
    }
    for (std::size_t j = rows; j-- > 0;) {
        for (std::size_t d = 0; d < dimension; ++d) {
            double known = 0.0;
            for (std::size_t k = j + 1; k < matrix.after(j); ++k)
                known += matrix.at(j, k) * right[k * dimension + d];
            right[j * dimension + d] = (right[j * dimension + d] - known) / matrix.at(j, j);
        }
    }
}

}  // namespace

KnotsAndControl spline_through_points(std::span<const double> places,
                                      std::span<const double> values, std::size_t dimension,
                                      std::size_t degree) {
    KnotsAndControl made{knots_beside(places, degree), Array<double>(values)};
    const SplineBasis basis(made.knots, degree, {NO_LIMIT, NO_LIMIT, 0.0});
    Band matrix = collocation(basis, places);
    solve(matrix, made.control, dimension);
    return made;
}

}  // namespace surfmesh
