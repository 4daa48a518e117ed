#include "triangulation/local_operations.hpp"

#include <utility>

namespace surfmesh {
namespace {

void attach(Triangulation& t, HalfEdge e, const StarEdge& rim) {
    t.adj[e] = rim.outer;
    if (rim.outer >= 0) t.adj[rim.outer] = e;
    t.fixed[e] = rim.fixed;
}

}  // namespace

bool is_convex(const Triangulation& t, HalfEdge e) {
    const HalfEdge f = t.adj[e];
    if (f < 0) return false;
    const Vertex a = t.tri[e], b = t.tri[f];
    const Vertex c = t.tri[prev_half_edge(e)], d = t.tri[prev_half_edge(f)];
    if (a < 0 || b < 0 || c < 0 || d < 0) return false;
    return orient(t.xy, a, d, c) > 0.0 && orient(t.xy, b, c, d) > 0.0;
}

void swap_edge(Triangulation& t, HalfEdge e) {
    const HalfEdge f = t.adj[e];
    const HalfEdge e1 = next_half_edge(e), e2 = prev_half_edge(e);
    const HalfEdge f1 = next_half_edge(f), f2 = prev_half_edge(f);
    const Vertex c = t.tri[e2], d = t.tri[f2];
    const HalfEdge twin_bc = t.adj[e1], twin_ad = t.adj[f1];
    if (t.has_segments()) {
        t.fixed[e] = t.fixed[f1];
        t.fixed[f] = std::exchange(t.fixed[e1], 0);
        t.fixed[f1] = 0;
    }
    t.tri[e1] = d;
    t.tri[f1] = c;
    t.adj[e] = twin_ad;
    t.adj[f] = twin_bc;
    if (twin_ad >= 0) t.adj[twin_ad] = e;
    if (twin_bc >= 0) t.adj[twin_bc] = f;
    t.adj[e1] = f1;
    t.adj[f1] = e1;
}

bool take_star(const Triangulation& t, HalfEdge e, StarPolygon& polygon) {
    polygon.rim.clear();
    polygon.triangles.clear();
    HalfEdge f = e;
    do {
        const HalfEdge opposite = next_half_edge(f);
        if (t.tri[opposite] < 0 || t.fixed[f] != 0) return false;
        polygon.rim.push_back({t.tri[opposite], t.adj[opposite], t.fixed[opposite]});
        polygon.triangles.push_back(f / 3);
        f = rotate_ccw(t, f);
        if (f == NIL) return false;  // a star that ends at the border
    } while (f != e);
    return polygon.rim.size() >= 3;
}

bool is_ear(const Triangulation& t, std::span<const Vertex> corners, std::size_t i) {
    const std::size_t n = corners.size();
    const Vertex p = corners[i], q = corners[(i + 1) % n], r = corners[(i + 2) % n];
    if (orient(t.xy, p, q, r) <= 0.0) return false;
    for (std::size_t k = 3; k < n; ++k) {
        const Vertex w = corners[(i + k) % n];
        if (orient(t.xy, p, q, w) >= 0.0 && orient(t.xy, q, r, w) >= 0.0 &&
            orient(t.xy, r, p, w) >= 0.0)
            return false;
    }
    return true;
}

HalfEdge fill_polygon(Triangulation& t, const StarPolygon& polygon, const Ears& ears) {
    Array<StarEdge> rim(polygon.rim);
    std::size_t slots = polygon.triangles.size();
    HalfEdge s = NIL;
    for (const std::size_t i : ears.first) {
        const std::size_t n = rim.size(), j = (i + 1) % n, k = (i + 2) % n;
        s = 3 * polygon.triangles[--slots];
        t.tri[s] = rim[i].start;
        t.tri[s + 1] = rim[j].start;
        t.tri[s + 2] = rim[k].start;
        attach(t, s, rim[i]);
        attach(t, s + 1, rim[j]);
        if (n == 3) {
            attach(t, s + 2, rim[k]);
        } else {
            rim[i] = {rim[i].start, s + 2, 0};
            t.fixed[s + 2] = 0;
            erase(rim, j);
        }
    }
    for (std::size_t dead = 0; dead < slots; ++dead) t.region[polygon.triangles[dead]] = DEAD;
    return s;
}

void fill_star(Triangulation& t, const StarPolygon& polygon, Vertex v) {
    Array<Triangle> slots(polygon.triangles);
    while (slots.size() < polygon.rim.size()) {
        slots.push_back(t.add_triangle());
        t.region[slots.back()] = t.region[slots[0]];
    }
    const std::size_t n = slots.size();
    for (std::size_t k = 0; k < n; ++k) {
        const HalfEdge s = 3 * slots[k];
        t.tri[s] = polygon.rim[k].start;
        t.tri[s + 1] = polygon.rim[(k + 1) % n].start;
        t.tri[s + 2] = v;
        attach(t, s, polygon.rim[k]);
        t.adj[s + 1] = 3 * slots[(k + 1) % n] + 2;
        t.adj[s + 2] = 3 * slots[(k + n - 1) % n] + 1;
        t.fixed[s + 1] = t.fixed[s + 2] = 0;
    }
}

HalfEdge remove_vertex(Triangulation& t, HalfEdge e) {
    StarPolygon polygon;
    if (!take_star(t, e, polygon)) return NIL;
    for (const StarEdge& edge : polygon.rim)
        if (edge.outer < 0) return NIL;
    const auto shape = [&](Vertex p, Vertex q, Vertex r) {
        return triangle_shape(t.xy, t.size, p, q, r);
    };
    return fill_polygon(t, polygon, best_ears(t, polygon, shape));
}

}  // namespace surfmesh
