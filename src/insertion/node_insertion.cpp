#include "insertion/node_insertion.hpp"

namespace surfmesh {
namespace {

constexpr double MOVE_WITHIN = 0.35;  // a vertex nearer than this to a new node becomes that node

/// May the vertex at the start of e go to p with its star left positive?
bool can_move(const Triangulation& t, HalfEdge e, Point2 p) {
    HalfEdge f = e;
    do {
        const Vertex a = t.tri[next_half_edge(f)], b = t.tri[prev_half_edge(f)];
        if (a < 0 || b < 0 || t.fixed[f] != 0 || side(t, a, b, p) <= 0.0) return false;
        f = rotate_ccw(t, f);
    } while (f != e);
    return true;
}

/// The corner of the triangle whose vertex can become the node, or NIL.
HalfEdge movable_corner(const Triangulation& t, Triangle triangle, Point2 place, SizeTensor h,
                        Vertex first_node) {
    for (HalfEdge e = 3 * triangle; e < 3 * triangle + 3; ++e) {
        const Vertex v = t.tri[e];
        if (v < 0 || v >= first_node) continue;
        const Point2 u = solve(h, t.xy[v] - place);
        if (dot(u, u) < MOVE_WITHIN * MOVE_WITHIN && can_move(t, e, place)) return e;
    }
    return NIL;
}

}  // namespace

HalfEdge corner_of(const Triangulation& t, Triangle triangle, Vertex v) {
    for (HalfEdge e = 3 * triangle; e < 3 * triangle + 3; ++e)
        if (t.tri[e] == v) return e;
    return NIL;
}

HalfEdge first_live(const Triangulation& t, HalfEdge start) {
    HalfEdge e = start;
    while (t.region[e / 3] == DEAD) e = e + 3 < 3 * t.triangles() ? e + 3 : 0;
    return e;
}

HalfEdge find_star(const Triangulation& t, HalfEdge near, Vertex v) {
    return corner_of(t, locate(t, near, t.xy[v]).triangle, v);
}

NodeInserted insert_node(Triangulation& t, HalfEdge start, Point2 place, SizeTensor h,
                         Vertex first_node) {
    const Triangle triangle = locate(t, start, place).triangle;
    const HalfEdge e = movable_corner(t, triangle, place, h, first_node);
    if (e != NIL) {
        const Vertex p = t.add_vertex(place, h);
        HalfEdge f = e;
        do {
            t.tri[f] = p;
            f = rotate_ccw(t, f);
        } while (f != e);
        return {p, e};
    }
    if (!open_cavity(t, triangle, place, h, true) && !open_cavity(t, triangle, place, h, false))
        return {NIL, 3 * triangle};
    const Vertex p = t.add_vertex(place, h);
    fill_cavity(t, p);
    return {p, 3 * t.cavity[0] + 2};
}

}  // namespace surfmesh
