// Moves of the front over the triangulation of the plane: place a circle, hand a triangle over.
//
// Each move keeps the front one simple loop, the border of what is DONE, and queues its new edges.
// A move that is not possible changes nothing.
#pragma once

#include "packing/packing_state.hpp"

namespace surfmesh {

inline constexpr int POCKET = 8;  // most circles on the rim of a polygon closed without one within

/// Nearest to the origin first (2.2): by the middle of the edge.
void queue(Packing& p, FrontEdge edge);

/// The outer half-edge b -> a of the front's edge a -> b.
inline HalfEdge outer_edge(const Packing& p, Vertex a) { return p.t.adj[p.front.edge(a)]; }

/// The corner across the outer triangle of a -> b: NIL on the hull.
inline Vertex outer_apex(const Packing& p, Vertex a) {
    return p.t.tri[prev_half_edge(outer_edge(p, a))];
}

/// Whether a circle can be, or was placed; if not, the circle in the way, or NIL for none.
struct Trial {
    bool possible;
    Vertex in_the_way;
};

/// Open the cavity of a circle on the front edge a -> b.
[[nodiscard]] Trial open_for(Packing& p, FrontEdge edge, const Circle& circle);

/// Fill the open cavity with a circle on the edge and advance the front. ``ratio``: got over wanted
/// radius. Returns the vertex.
Vertex place(Packing& p, FrontEdge edge, const Circle& circle, double ratio);

/// Hand over the outer triangle of a -> b when its apex is a neighbour on the front.
bool close_corner(Packing& p, FrontEdge edge);

/// Hand over the first outer triangle, going round the front from a, that fills a corner.
///
/// Every pocket between the front and the hull is a polygon and has such an ear.
bool close_first_corner(Packing& p, Vertex a);

/// Hand over the outer triangles between ``steps`` edges of the front from a on and the
///
/// edge that spans them, which is one of the outer part. The polygon is
/// triangulated as the outer part is, ear by ear. False when some ear is missing.
bool close_pocket(Packing& p, Vertex a, int steps);

}  // namespace surfmesh
