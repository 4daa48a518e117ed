// How many triangles a vertex should have, and has: six inside, three on a straight border.
#pragma once

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"

namespace surfmesh {

/// Triangles of v beyond those of a regular vertex, inside or on a straight border.
[[nodiscard]] inline int excess(const Stars& stars, Vertex v) {
    return stars.degree[v] - (stars.frozen[v] != 0 ? 3 : 6);
}

/// Is the start of e on the border, with both its border edges nearly in one line?
[[nodiscard]] bool is_on_straight_border(const Triangulation& t, const SurfaceFrames& s,
                                         HalfEdge e);

}  // namespace surfmesh
