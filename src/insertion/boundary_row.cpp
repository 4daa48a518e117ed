#include "insertion/boundary_row.hpp"

#include <algorithm>
#include <cmath>

#include "insertion/node_insertion.hpp"
#include "triangulation/local_operations.hpp"

namespace surfmesh {
namespace {

/// Squared metric length from vertex v to a point with its size tensor.
double squared_distance(const Triangulation& t, Vertex v, Point2 p, SizeTensor h) {
    const Point2 u = solve(0.5 * (t.size[v] + h), t.xy[v] - p);
    return dot(u, u);
}

/// Move the vertex at the start of e half the way to p, if its star stays positive.
void move_half_way(Triangulation& t, HalfEdge e, Point2 p) {
    const Vertex v = t.tri[e];
    const Point2 old = t.xy[v];
    t.xy[v] = 0.5 * (old + p);
    HalfEdge f = e;
    do {
        const Vertex a = t.tri[next_half_edge(f)], b = t.tri[prev_half_edge(f)];
        if (a < 0 || b < 0 || orient(t.xy, v, a, b) <= 0.0) {
            t.xy[v] = old;
            return;
        }
        f = rotate_ccw(t, f);
    } while (f != e);
}

/// The half-edge from an earlier vertex of the row near by, moved towards this place; or NIL.
///
/// Looked at are the corners of the triangle, and those of its neighbours opposite to it.
HalfEdge join(Triangulation& t, Triangle triangle, Point2 p, SizeTensor h, Vertex first) {
    for (int i = 0; i < 6; ++i) {
        HalfEdge e = 3 * triangle + i % 3;
        if (i >= 3) {
            if (t.adj[e] < 0) continue;
            e = prev_half_edge(t.adj[e]);
        }
        const Vertex v = t.tri[e];
        if (v >= first && squared_distance(t, v, p, h) < APART * APART) {
            move_half_way(t, e, p);
            return e;
        }
    }
    return NIL;
}

/// Remove the vertices before ``first`` next to the start of e that are too near.
///
/// Returns a half-edge that starts there, or one near by.
HalfEdge clear_around(Triangulation& t, HalfEdge e, Vertex first) {
    const Vertex p = t.tri[e];
    HalfEdge start = e;
    while (true) {
        const Vertex w = t.tri[next_half_edge(e)];
        HalfEdge live = NIL;
        if (0 <= w && w < first && squared_distance(t, w, t.xy[p], t.size[p]) < AROUND * AROUND)
            live = remove_vertex(t, t.adj[e]);
        if (live == NIL) {
            e = rotate_ccw(t, e);
            if (e == start) return e;
        } else {
            start = e = find_star(t, live, p);
            if (e == NIL) return live;
        }
    }
}

}  // namespace

Array<Point2> apexes(const Background& background, std::span<const Point2> nodes,
                     std::span<const Segment> segments) {
    Array<Point2> found;
    found.reserve(segments.size());
    for (const auto [a, b] : segments) {
        const Point2 start = nodes[a], end = nodes[b];
        const Point2 middle = 0.5 * (start + end);
        const SizeTensor h = background.size_at(middle.x, middle.y);
        const Point2 u = solve(h, end - start);
        const double length2 = dot(u, u);
        const double height = std::sqrt(std::max(1.0 - 0.25 * length2, LOWEST * LOWEST) / length2);
        const Point2 across{h.xy * u.x - h.xx * u.y, h.yy * u.x - h.xy * u.y};  // H (-v, u)
        const Point2 apex = middle + height * across;
        if (std::isfinite(apex.x) && std::isfinite(apex.y)) found.push_back(apex);
    }
    return found;
}

Vertex insert_row(Triangulation& t, std::span<const Point2> apex,
                  std::span<const SizeTensor> size) {
    const Vertex first = t.vertices();
    HalfEdge near = 0;
    for (std::size_t k = 0; k < apex.size(); ++k) {
        near = first_live(t, near);
        const Triangle triangle = locate(t, near, apex[k]).triangle;
        HalfEdge e = join(t, triangle, apex[k], size[k], first);
        if (e == NIL) {
            const NodeInserted node = insert_node(t, 3 * triangle, apex[k], size[k], first);
            if (node.vertex == NIL) {
                near = node.half_edge;
                continue;
            }
            e = node.half_edge;
        }
        near = clear_around(t, e, first);
    }
    return first;
}

}  // namespace surfmesh
