// Small linear systems by elimination, and how far they are from singular.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace surfmesh {

template <std::size_t n>
using SquareMatrix = std::array<std::array<double, n>, n>;

/// Solve in place: right becomes the solution. Returns |det|; the solution is of no use where
/// that is zero or no number.
template <std::size_t n>
double solve(SquareMatrix<n> matrix, std::array<double, n>& right) {
    double determinant = 1.0;
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (std::abs(matrix[i][k]) > std::abs(matrix[pivot][k])) pivot = i;
        std::swap(matrix[k], matrix[pivot]);
        std::swap(right[k], right[pivot]);
        determinant *= std::abs(matrix[k][k]);
        if (!(std::abs(matrix[k][k]) > 0.0)) return 0.0;
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = matrix[i][k] / matrix[k][k];
            for (std::size_t j = k; j < n; ++j) matrix[i][j] -= factor * matrix[k][j];
            right[i] -= factor * right[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) right[k] -= matrix[k][j] * right[j];
        right[k] /= matrix[k][k];
    }
    return determinant;
}

}  // namespace surfmesh
