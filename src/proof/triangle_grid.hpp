// The grid of a triangle of the (u, v) plane with n cells along a side: (n + 1) (n + 2) / 2 places.
#pragma once

#include <cstddef>

#include "proof/plane_piece.hpp"
#include "values/array.hpp"

namespace surfmesh {

inline std::size_t points_of_grid(std::size_t n) { return (n + 1) * (n + 2) / 2; }

/// Calls f(weights) for the places of the grid, one after the other.
template <class Function>
void for_grid(std::size_t n, Function f) {
    const double cells = static_cast<double>(n);
    for (std::size_t i = 0; i <= n; ++i)
        for (std::size_t j = 0; i + j <= n; ++j) {
            const double a = static_cast<double>(i) / cells, b = static_cast<double>(j) / cells;
            f(Barycentric{1.0 - a - b, a, b});
        }
}

inline void append_grid(const PlanePiece& piece, std::size_t n, Array<Point2>& places) {
    for_grid(n, [&](const Barycentric& l) { places.push_back(piece.at(l)); });
}

}  // namespace surfmesh
