// The star of each vertex: where a walk around it starts, whether it may move, its triangles.
//
// Swaps, collapses and splits make them stale; moves of vertices do not.
#pragma once

#include "triangulation/triangulation.hpp"

namespace surfmesh {

struct Stars {
    Array<HalfEdge> start;       // of each vertex a half-edge that leaves it, NIL where none does
    Array<std::uint8_t> frozen;  // not to be moved: on the border, or on a fixed edge
    Array<std::int32_t> degree;  // of each vertex, how many triangles it has
    Array<std::uint8_t> shared;  // is its star in more than one part? Empty where there are none

    [[nodiscard]] bool is_shared(Vertex v) const { return !shared.empty() && shared[v] != 0; }
};

/// Find the stars of all vertices.
void find_stars(const Triangulation& t, Stars& stars);

/// Call ``visit`` with the half-edges that leave the start of e, counter-clockwise from e.
template <class Visit>
void for_each_in_star(const Triangulation& t, HalfEdge e, Visit visit) {
    const HalfEdge first = e;
    do {
        visit(e);
        e = rotate_ccw(t, e);
    } while (e != first);
}

}  // namespace surfmesh
