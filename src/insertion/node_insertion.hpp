// Section 3, step 2: boundary nodes become vertices of the packing.
//
// In: a triangulation of the plane with room for fixed edges, a point and its size tensor. Out:
// the new vertex and a half-edge that leaves it. A vertex of the packing that is very near is
// moved there; otherwise the triangle, or the edge, that holds the point is split together with
// its neighbours. Fixed edges stay, real triangles stay counter-clockwise, exactly.
#pragma once

#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// The half-edge of the triangle that starts at v, or NIL.
HalfEdge corner_of(const Triangulation& t, Triangle triangle, Vertex v);

/// A half-edge of the next triangle in use, from that of ``start`` on. There is one.
HalfEdge first_live(const Triangulation& t, HalfEdge start = 0);

/// A half-edge that starts at v, sought by a walk from ``near``; or NIL.
HalfEdge find_star(const Triangulation& t, HalfEdge near, Vertex v);

struct NodeInserted {
    Vertex vertex;       // NIL: a node or a segment has the place
    HalfEdge half_edge;  // leaves the vertex, or is near by
};

/// Make ``place`` a vertex. Vertices from ``first_node`` on are boundary nodes and stay.
NodeInserted insert_node(Triangulation& t, HalfEdge start, Point2 place, SizeTensor h,
                         Vertex first_node);

}  // namespace surfmesh
