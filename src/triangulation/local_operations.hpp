// Local changes of a triangulation: swap an edge, remove a vertex. Orientation is kept exactly.
#pragma once

#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// Can e be swapped: is its quadrilateral strictly convex at both ends of e?
[[nodiscard]] bool is_convex(const Triangulation& t, HalfEdge e);

/// Replace the edge a-b by c-d; the two triangles keep their slots.
///
///          c                       c            before: e a->b, e1 b->c, e2 c->a
///        / | \                   /   \                  f b->a, f1 a->d, f2 d->b
///    e2 /  |  \ e1           e2 /     \ f
///      /   |   \               / e1 f1 \        after:  e a->d, e1 d->c, e2 c->a
///     a   e|f   b     to      a --------- b             f b->c, f1 c->d, f2 d->b
///      \   |   /               \       /
///    f1 \  |  / f2            e \     / f2      (e runs from a to b; c-d is drawn
///        \ | /                   \   /           as the level line on the right)
///          d                       d
void swap_edge(Triangulation& t, HalfEdge e);

/// Remove the vertex at the start of e and triangulate its star anew, ear by ear.
///
/// Returns a half-edge of the new triangles, or NIL when the vertex cannot go: its star meets the
/// hull or the border, or a fixed edge ends there. Two slots go DEAD. There are segments.
HalfEdge remove_vertex(Triangulation& t, HalfEdge e);

}  // namespace surfmesh
