// The four sides of the (u, v) rectangle: which coincide in space, which shrink to a point.
//
//     v1 +-----2-----+       a side's own parameter t in [0, 1] rises with its variable; sides that
//        |           |       coincide do so at t and t, or, reversed, at t and 1 - t
//        3           1
//        |           |       In: a surface, and how far rounding moves its sides. Out: a record.
//     v0 +-----0-----+
//        u0          u1
#pragma once

#include <array>

#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Of a side: it counts as met within this fraction of the surface's diagonal. sin(pi) is 1e-16, a
/// real gap is far larger.
inline constexpr double SAME_SIDE = 1e-9;

struct CoincidentSides {
    std::array<bool, 4> collapsed{};             // the side is one point in space
    std::array<int, 4> partner{-1, -1, -1, -1};  // the side that it coincides with, or -1
    std::array<bool, 4> reversed{};              // t meets 1 - t of the partner

    [[nodiscard]] bool has_point() const {
        return collapsed[0] || collapsed[1] || collapsed[2] || collapsed[3];
    }
};

/// rounding: of each side, as a fraction of the surface. The reader says whether it could be told.
[[nodiscard]] CoincidentSides coincident_sides(SurfaceReader& surface,
                                               const std::array<double, 4>& rounding);

}  // namespace surfmesh
