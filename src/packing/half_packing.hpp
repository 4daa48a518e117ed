// Half of a large packing: on the left of a line of circles.
//
// The front starts along the line. What is behind it, on the right, is closed off by a vertex
// ``behind`` and a fan of triangles that are neither done nor to be done:
//
//            to do                        the front: c4 -> c3 -> ... -> c0 -> behind -> c4
//     c0 - c1 - c2 - c3 - c4   line       of which the edges at ``behind`` lie outside the box
//       `.  \    |   /   .'
//          `. behind  .'                  fan k: (behind, c(k+1), c(k))
//
// Both halves of a line, the other turned by half a turn, become one triangulation of the plane:
// fans and the two ghosts beside them go, and the circles of the line have one number each.
#pragma once

#include "packing/packing_state.hpp"

namespace surfmesh {

/// Start the front along the line of circles. ``behind``: on its right, outside the box.
[[nodiscard]] PackingStatus start_along(Packing& p, std::span<const Circle> line,
                                        const Circle& behind);

/// Put the other half, which started along the same ``line`` circles from the other end, to ``p``.
///
/// The front of both is given up. False, and nothing is changed, where the whole would not be
/// convex: where circles have got behind the line.
[[nodiscard]] bool join_halves(Packing& p, const Packing& other, Vertex line);

}  // namespace surfmesh
