// The grid of a triangle of the (u, v) plane with n cells along a side: (n + 1) (n + 2) / 2 places.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "proof/triangle_bounds.hpp"
#include "values/array.hpp"

namespace surfmesh {

inline std::size_t points_of_grid(std::size_t n) { return (n + 1) * (n + 2) / 2; }

inline void append_grid(const PlaneCorners& uv, std::size_t n, Array<Point2>& places) {
    const double cells = static_cast<double>(n);
    for (std::size_t i = 0; i <= n; ++i)
        for (std::size_t j = 0; i + j <= n; ++j) {
            const double a = static_cast<double>(i) / cells, b = static_cast<double>(j) / cells;
            places.push_back((1.0 - a - b) * uv[0] + a * uv[1] + b * uv[2]);
        }
}

/// Rounding of (u, v) moves places by this part of the triangle.
inline double rounded_part(const PlaneCorners& uv) {
    const auto part = [](double x, double y, double z) {
        const double size = std::max({std::abs(x), std::abs(y), std::abs(z)});
        const double range = std::max({x, y, z}) - std::min({x, y, z});
        return range > 0.0 ? 0x1p-49 * size / range : 0.0;
    };
    return part(uv[0].x, uv[1].x, uv[2].x) + part(uv[0].y, uv[1].y, uv[2].y);
}

}  // namespace surfmesh
