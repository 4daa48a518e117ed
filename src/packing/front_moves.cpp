#include "packing/front_moves.hpp"

#include <algorithm>

#include "triangulation/local_operations.hpp"

namespace surfmesh {
namespace {

constexpr double GOOD_SHAPE = 0.8;  // two done triangles both better than this are left as they are

/// Swap the done edge e if that betters the worse of its two triangles.
///
/// The polygon between the circles is triangulated as it is left over; a swap with what was done
/// before chooses the better of the two diagonals, as soon as both are known.
void choose_diagonal(Packing& p, HalfEdge e) {
    Triangulation& t = p.t;
    const HalfEdge f = t.adj[e];
    if (t.region[e / 3] != DONE || t.region[f / 3] != DONE) return;
    const Vertex a = t.tri[e], b = t.tri[f];
    const Vertex c = t.tri[prev_half_edge(e)], d = t.tri[prev_half_edge(f)];
    const double old =
        std::min(triangle_shape(t.xy, t.size, a, b, c), triangle_shape(t.xy, t.size, b, a, d));
    if (old > GOOD_SHAPE) return;
    const double swapped =
        std::min(triangle_shape(t.xy, t.size, a, d, c), triangle_shape(t.xy, t.size, b, c, d));
    if (!(swapped > old + 1e-3) || !is_convex(t, e)) return;
    swap_edge(t, e);  // edges a-d and b-c have changed slots: the front may hold them
    if (t.region[t.adj[e] / 3] == TODO) p.front.links[a].edge = e;
    if (t.region[t.adj[f] / 3] == TODO) p.front.links[b].edge = f;
}

}  // namespace

void queue(Packing& p, FrontEdge edge) {
    const Point2 middle = 0.5 * (p.t.xy[edge.a] + p.t.xy[edge.b]);
    const Point2 away = middle - p.limits.origin;
    p.heap.push({dot(away, away), edge});
}

Trial open_for(Packing& p, FrontEdge edge, const Circle& circle) {
    Triangulation& t = p.t;
    const HalfEdge e = outer_edge(p, edge.a);
    const Location found = locate(t, e, circle.centre, true);
    if (found.barrier != NIL) {
        const Vertex v = t.tri[found.barrier];
        const bool is_support = v == edge.a || v == edge.b;
        return {false, is_support ? t.tri[next_half_edge(found.barrier)] : v};
    }
    if (!open_cavity(t, found.triangle, circle.centre, circle.size, true) ||
        t.mark[e / 3] != t.search)
        return {false, t.tri[prev_half_edge(e)]};
    return {true, NIL};
}

Vertex place(Packing& p, FrontEdge edge, const Circle& circle, double ratio) {
    Triangulation& t = p.t;
    const Vertex v = t.add_vertex(circle.centre, circle.size);
    p.front.links.push_back({});
    p.radius.push_back(ratio);
    fill_cavity(t, v);
    const HalfEdge done = outer_edge(p, edge.a);  // b -> a in the new triangle (b, a, v)
    t.region[done / 3] = DONE;
    p.front.link(edge.a, v, next_half_edge(done));
    p.front.link(v, edge.b, prev_half_edge(done));
    queue(p, {edge.a, v});
    queue(p, {v, edge.b});
    choose_diagonal(p, done);
    return v;
}

bool close_corner(Packing& p, FrontEdge edge) {
    Triangulation& t = p.t;
    const HalfEdge e = outer_edge(p, edge.a);  // b -> a
    const HalfEdge f = next_half_edge(e), g = prev_half_edge(e);
    const Vertex apex = t.tri[g];
    if (apex == NIL) return false;
    if (apex == p.front.next(edge.b)) {
        t.region[e / 3] = DONE;
        p.front.link(edge.a, apex, f);
        p.front.unlink(edge.b);
        queue(p, {edge.a, apex});
    } else if (apex == p.front.prev(edge.a)) {
        t.region[e / 3] = DONE;
        p.front.link(apex, edge.b, g);
        p.front.unlink(edge.a);
        queue(p, {apex, edge.b});
    } else {
        return false;
    }
    ++p.counts.closed;
    if (triangle_shape(t.xy, t.size, t.tri[e], t.tri[f], t.tri[g]) < GOOD_SHAPE)
        for (const HalfEdge side : {e, f, g}) choose_diagonal(p, side);
    return true;
}

bool close_first_corner(Packing& p, Vertex a) {
    Vertex b = a;
    do {
        const Vertex next = p.front.next(b);
        if (outer_apex(p, b) == p.front.next(next)) return close_corner(p, {b, next});
        b = next;
    } while (b != a);
    return false;
}

bool close_pocket(Packing& p, Vertex a, int steps) {
    for (; steps > 1; --steps) {
        Vertex v = a;
        int tried = 1;
        while (outer_apex(p, v) != p.front.next(p.front.next(v))) {
            v = p.front.next(v);
            if (++tried == steps) return false;
        }
        close_corner(p, {v, p.front.next(v)});
    }
    return true;
}

}  // namespace surfmesh
