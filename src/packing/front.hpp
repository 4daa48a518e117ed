// The generation front (section 2.1 of the paper): one closed loop of circles, a doubly linked list.
//
// The loop is the border of the region DONE of a triangulation of the whole plane. To advance is
// to hand triangles over from TODO to DONE:
//
//     insert: the new circle p on the edge a -> b          close: the corner at b is filled
//                                                          (c = next of b)
//             p                                                 c
//            / \                                               / \            .
//           /   \     a -> p -> b                    a -----> /   \      a -> c, b leaves
//          a --- b                                    \ new  /     |
//           done                                       \    b      |
#pragma once

#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

/// The neighbours of a circle on the front; all are NIL off it.
struct FrontLink {
    Vertex next = NIL, prev = NIL;
    HalfEdge edge = NIL;  // done half-edge from the circle to the next
};

struct FrontEdge {
    Vertex a, b;
};

/// The links of all vertices of the triangulation.
struct Front {
    Array<FrontLink> links;

    [[nodiscard]] Vertex next(Vertex v) const { return links[v].next; }
    [[nodiscard]] Vertex prev(Vertex v) const { return links[v].prev; }
    [[nodiscard]] HalfEdge edge(Vertex v) const { return links[v].edge; }
    /// Is a -> b an edge of the front?
    [[nodiscard]] bool has(FrontEdge e) const { return links[e.a].next == e.b; }

    /// Make a -> b an edge of the front, with e its half-edge in a done triangle.
    void link(Vertex a, Vertex b, HalfEdge e) {
        links[a].next = b;
        links[a].edge = e;
        links[b].prev = a;
    }
    /// b has left the front.
    void unlink(Vertex b) { links[b] = {}; }
};

/// How many steps along the front lead from a to b, 0 when more than ``most``.
inline int steps_between(const Front& front, Vertex a, Vertex b, int most) {
    for (int k = 1; k <= most && a != NIL; ++k) {
        a = front.next(a);
        if (a == b) return k;
    }
    return 0;
}

}  // namespace surfmesh
