#include "triangulation/local_operations.hpp"

#include <utility>

namespace surfmesh {
namespace {

/// Corner i of the polygon whose outer half-edges are in the rim; n of them are left.
Vertex corner(const Triangulation& t, int n, int i) { return t.tri[next_half_edge(t.rim[i % n])]; }

/// Is the corner after rim vertex i positive, with no other rim vertex in its triangle?
bool is_ear(const Triangulation& t, int n, int i) {
    const Vertex p = corner(t, n, i), q = corner(t, n, i + 1), r = corner(t, n, i + 2);
    if (orient(t.xy, p, q, r) <= 0.0) return false;
    for (int k = 3; k < n; ++k) {
        const Vertex w = corner(t, n, i + k);
        if (orient(t.xy, p, q, w) >= 0.0 && orient(t.xy, q, r, w) >= 0.0 &&
            orient(t.xy, r, p, w) >= 0.0)
            return false;
    }
    return true;
}

/// The ear of best shape of the rim; every simple polygon has one.
int best_ear(const Triangulation& t, int n) {
    int best = NIL;
    double best_shape = -1.0;
    for (int i = 0; i < n; ++i) {
        if (!is_ear(t, n, i)) continue;
        const double found =
            triangle_shape(t.xy, t.size, corner(t, n, i), corner(t, n, i + 1), corner(t, n, i + 2));
        if (found > best_shape) {
            best = i;
            best_shape = found;
        }
    }
    return best;
}

void attach(Triangulation& t, HalfEdge e, HalfEdge outer) {
    t.adj[e] = outer;
    t.adj[outer] = e;
    t.fixed[e] = t.fixed[outer];
}

/// Outer twins of the star of e's start into the rim, its triangles into the cavity.
bool collect_star(Triangulation& t, HalfEdge e) {
    t.rim.clear();
    t.cavity.clear();
    HalfEdge f = e;
    do {
        if (t.tri[next_half_edge(f)] < 0 || t.fixed[f] != 0) return false;
        const HalfEdge outer = t.adj[next_half_edge(f)];
        if (outer < 0) return false;
        t.rim.push_back(outer);
        t.cavity.push_back(f / 3);
        f = rotate_ccw(t, f);
        if (f == NIL) return false;  // a star that ends at the border
    } while (f != e);
    return t.rim.size() >= 3;
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

HalfEdge remove_vertex(Triangulation& t, HalfEdge e) {
    if (!collect_star(t, e)) return NIL;
    auto n = static_cast<int>(t.rim.size());
    int slots = n;
    while (true) {
        const int i = n == 3 ? 0 : best_ear(t, n);
        const int j = (i + 1) % n, k = (i + 2) % n;
        const Vertex p = corner(t, n, i), q = corner(t, n, j), r = corner(t, n, k);
        const HalfEdge s = 3 * t.cavity[--slots];
        t.tri[s] = p;
        t.tri[s + 1] = q;
        t.tri[s + 2] = r;
        attach(t, s, t.rim[i]);
        attach(t, s + 1, t.rim[j]);
        if (n == 3) {
            attach(t, s + 2, t.rim[k]);
            for (int dead = 0; dead < slots; ++dead) t.region[t.cavity[dead]] = DEAD;
            return s;
        }
        t.fixed[s + 2] = 0;
        t.rim[i] = s + 2;
        for (int m = j; m < n - 1; ++m) t.rim[m] = t.rim[m + 1];
        --n;
    }
}

}  // namespace surfmesh
