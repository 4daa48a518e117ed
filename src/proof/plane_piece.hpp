// The part of the (u, v) plane that a triangle stands for: a triangle whose sides may be bent.
//
//          2          psi(l) = sum l_i u_i + 4 sum_k l_i l_j bend_k        side k from i = k to j
//         / `.
//     2  /    ) 1     bend_k: how far the middle of side k is moved. psi is quadratic, and a map
//       (    /        of neighbours has the same curve on their common side.
//        0--1
//          0
//
// In: corners and bends. Out: places, and derivatives of psi, which are linear. The tangential part
// of how r(psi) differs from linear is taken away by such bends (curved_pieces.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "values/point.hpp"

namespace surfmesh {

using SpaceCorners = std::array<Point3, 3>;
using PlaneCorners = std::array<Point2, 3>;
using PlaneBends = std::array<Point2, 3>;
using SpaceBends = std::array<Point3, 3>;  // likewise, of the sides of a curved triangle
using Barycentric = std::array<double, 3>;

struct PlanePiece {
    const PlaneCorners& uv;
    const PlaneBends& bend;

    [[nodiscard]] bool is_straight() const {
        for (const Point2 b : bend)
            if (b.x != 0.0 || b.y != 0.0) return false;
        return true;
    }
    [[nodiscard]] Point2 at(const Barycentric& l) const {
        const Point2 flat = l[0] * uv[0] + l[1] * uv[1] + l[2] * uv[2];
        if (is_straight()) return flat;
        return flat + 4.0 * (l[0] * l[1] * bend[0] + l[1] * l[2] * bend[1] + l[2] * l[0] * bend[2]);
    }
    /// The derivative of psi along side k, from corner k to the next.
    [[nodiscard]] Point2 along(std::size_t k, const Barycentric& l) const {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;  // w_k = -1, w_i = 1, w_j = 0
        return uv[i] - uv[k] + 4.0 * ((l[k] - l[i]) * bend[k] + l[j] * bend[i] - l[j] * bend[j]);
    }
    /// The second derivative along sides k and m, the same everywhere.
    [[nodiscard]] Point2 second(std::size_t k, std::size_t m) const {
        if (k == m) return -8.0 * bend[k];
        return 4.0 * (bend[k] + bend[m] - bend[3 - k - m]);
    }
    /// The third control point of side k: the piece lies in the hull of these and of the corners.
    [[nodiscard]] Point2 control(std::size_t k) const {
        return 0.5 * (uv[k] + uv[(k + 1) % 3]) + 2.0 * bend[k];
    }
};

constexpr std::array<Barycentric, 3> AT_CORNERS = {
    {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

/// Rounding of (u, v) moves places by this part of the triangle.
inline double rounded_part(const PlanePiece& piece) {
    const auto part = [](double x, double y, double z, double bend) {
        const double size = std::max({std::abs(x), std::abs(y), std::abs(z)}) + bend;
        const double range = std::max({x, y, z}) - std::min({x, y, z});
        return range > 0.0 ? 0x1p-47 * size / range : 0.0;
    };
    const auto& [a, b, c] = piece.uv;
    const auto& [d, e, f] = piece.bend;
    return part(a.x, b.x, c.x, std::abs(d.x) + std::abs(e.x) + std::abs(f.x)) +
           part(a.y, b.y, c.y, std::abs(d.y) + std::abs(e.y) + std::abs(f.y));
}

}  // namespace surfmesh
