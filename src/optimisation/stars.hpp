// The star of each vertex: where a walk around it starts, whether it may move, its triangles.
//
// Collapses and splits make them stale, and swaps where they do not renew the four that they change;
// moves of vertices do not.
#pragma once

#include <optional>
#include <span>

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

/// Find the star of the start of e anew, whose degree is known and which stays frozen or free.
///
/// As ``find_stars`` has it, to the half-edge. False where two borders meet there: a walk around the
/// vertex does not come to all of its triangles.
[[nodiscard]] bool renew_star(const Triangulation& t, HalfEdge e, Stars& stars);

/// The triangles at the vertices, in their order; nothing where two borders meet at one of these.
[[nodiscard]] std::optional<Array<Triangle>> triangles_around(const Triangulation& t,
                                                              const Stars& stars,
                                                              std::span<const Vertex> vertices);

/// Call ``visit`` with the half-edges that leave the start of e, counter-clockwise from e.
template <class Visit>
void for_each_in_star(const Triangulation& t, HalfEdge e, Visit visit) {
    const HalfEdge first = e;
    do {
        visit(e);
        e = rotate_ccw(t, e);
    } while (e != first);
}

/// The same where a star may end at a border on both sides: in no order.
template <class Visit>
void for_each_in_fan(const Triangulation& t, HalfEdge e, Visit visit) {
    HalfEdge f = e;
    do {
        visit(f);
        f = rotate_ccw(t, f);
    } while (f >= 0 && f != e);
    if (f >= 0) return;
    for (f = t.adj[e]; f >= 0; f = t.adj[next_half_edge(f)]) visit(next_half_edge(f));
}

}  // namespace surfmesh
