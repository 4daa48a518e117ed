// What creases of the surface add to the second derivatives along a triangle's sides.
//
// Where r_u jumps by J across a line u = k, r'(x + s u_i) - r'(x + s u_j) along the side e of the
// lemma (triangle_bounds.hpp) has the jump |e_u| J beside the integral of r'', so that
//
//     l_i l_j / 2 (sup |d . r''(e, e)| + 2 |e_u| |d . J|)      takes the place of  l_i l_j / 2 sup
//
// as a straight path meets the line once. Over a cell with sides e / n that falls with n alone: it is
// counted as often as the finest cells need. Differences of r'' have it too.
//
// In: suprema of r'' beside creases, the jumps along a triangle's axes. Out: its bounds.
#pragma once

#include <array>

#include "proof/side_bends.hpp"

namespace surfmesh {

/// Cells of a closer look: at most so many along a side.
inline constexpr double FINEST_CELLS = 64.0;

/// Of r_u and r_v, along a triangle's axes.
struct CreaseJumps {
    std::array<double, 3> u{}, v{};

    [[nodiscard]] bool any() const {
        return u != std::array<double, 3>{} || v != std::array<double, 3>{};
    }
};

TriangleBounds bounds_with_creases(const SideBends& smooth, const CreaseJumps& jumps,
                                   const PlaneCorners& uv, const TriangleFrame& frame,
                                   double corner);

}  // namespace surfmesh
