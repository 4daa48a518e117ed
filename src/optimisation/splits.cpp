#include "optimisation/splits.hpp"

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t SPLITS_TOGETHER = 1 << 14;  // triangles looked at together

double middle(double a, double b) { return 0.5 * (a + b); }
Point3 middle(Point3 a, Point3 b) { return 0.5 * (a + b); }
MetricRoot3 middle(const MetricRoot3& a, const MetricRoot3& b) {
    return {middle(a.xx, b.xx), middle(a.xy, b.xy), middle(a.xz, b.xz),
            middle(a.yy, b.yy), middle(a.yz, b.yz), middle(a.zz, b.zz)};
}

/// Split the edge e in the middle.
void halve(Triangulation& t, SurfaceFrames& s, VertexMarks& marks, HalfEdge e) {
    if (t.xy.size() >= s.limits.most_vertices) return;
    const Vertex a = t.tri[e], b = t.tri[t.adj[e]];
    const Vertex p = split_edge(t, e, 0.5 * (t.xy[a] + t.xy[b]));
    if (p == NIL) return;
    set_between(t, s, marks, p, a, b);
    marks.touch(a);
    marks.touch(b);
}

void join(Triangulation& t, HalfEdge e, HalfEdge twin) {
    t.adj[e] = twin;
    if (twin >= 0) t.adj[twin] = e;
}

/// The edge of triangle k that lies farthest from the surface and may be split, or NIL.
///
/// NIL too where a corner is ``first`` or a later vertex.
HalfEdge farthest_edge(const Triangulation& t, const SurfaceFrames& s, Triangle k, Vertex first) {
    HalfEdge best = NIL;
    double farthest = 0.0;
    for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
        const Vertex a = t.tri[e], b = t.tri[next_half_edge(e)];
        if (a >= first || b >= first) return NIL;
        if (t.adj[e] < 0 || t.fixed[e] != 0) continue;
        const double least = s.limits.least_size;
        if (least > 0.0 && norm(s.point[b] - s.point[a]) < 2.0 * least) continue;
        const double far = std::abs(rise(s, a, b)) + std::abs(rise(s, b, a));
        if (far > farthest) {
            best = e;
            farthest = far;
        }
    }
    return best;
}

/// Is e, as the first half-edge of its edge, to be split? Not at vertices from ``first`` on.
bool is_long(const Triangulation& t, const SurfaceFrames& s, const VertexMarks& marks, HalfEdge e,
             Vertex first, double longest) {
    const Vertex a = t.tri[e];
    if (a >= first || t.adj[e] <= e || t.fixed[e] != 0 || t.region[e / 3] == DEAD) return false;
    const Vertex b = t.tri[t.adj[e]];
    if (b >= first || (marks.active[a] == 0 && marks.active[b] == 0)) return false;
    return is_longer(s, a, b, longest);
}

bool is_active(const Triangulation& t, const VertexMarks& marks, Triangle k) {
    return marks.active[t.tri[3 * k]] || marks.active[t.tri[3 * k + 1]] ||
           marks.active[t.tri[3 * k + 2]];
}

/// The triangles with an edge to be split, as they are before any is.
Array<Triangle> with_long_edge(const Triangulation& t, const SurfaceFrames& s,
                               const VertexMarks& marks, double longest) {
    const Vertex end = t.vertices();
    return collect_by_blocks<Triangle>(
        t.region.size(), SPLITS_TOGETHER,
        [&](std::size_t first, std::size_t last, Array<Triangle>& own) {
            for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k) {
                const HalfEdge e = 3 * k;
                if (t.region[k] == DEAD || !is_active(t, marks, k)) continue;
                if (is_long(t, s, marks, e, end, longest) ||
                    is_long(t, s, marks, e + 1, end, longest) ||
                    is_long(t, s, marks, e + 2, end, longest))
                    own.push_back(k);
            }
        });
}

}  // namespace

void set_between(Triangulation& t, SurfaceFrames& s, VertexMarks& marks, Vertex p, Vertex a,
                 Vertex b) {
    s.resize(t.xy.size());
    marks.resize(t.xy.size());
    s.point[p] = middle(s.point[a], s.point[b]);
    s.tangent_map[p] = s.tangent_map[a];
    s.normal[p] = s.normal[a];
    t.size[p] = t.size[a];
    s.scale[p] = middle(s.scale[a], s.scale[b]);
    s.size[p] = middle(s.size[a], s.size[b]);
    if (s.is_anisotropic) s.metric_root[p] = middle(s.metric_root[a], s.metric_root[b]);
    marks.touch(p);
}

Vertex split_edge(Triangulation& t, HalfEdge e, Point2 place) {
    const HalfEdge f = t.adj[e];
    const HalfEdge e1 = next_half_edge(e), f1 = next_half_edge(f);
    const Vertex a = t.tri[e], b = t.tri[f];
    const Vertex c = t.tri[prev_half_edge(e)], d = t.tri[prev_half_edge(f)];
    const auto positive = [&](Vertex from, Vertex to) {
        return orient(place, t.xy[from], t.xy[to]) > 0.0;
    };
    if (!positive(c, a) || !positive(b, c) || !positive(d, b) || !positive(a, d)) return NIL;
    const Vertex p = t.add_vertex(place, t.size[a]);
    const Triangle k = t.add_triangle();
    t.region[k] = t.region[e / 3];
    t.region[t.add_triangle()] = t.region[f / 3];
    const HalfEdge g = 3 * k, h = g + 3;  // (p, b, c), (p, a, d)
    const HalfEdge twin_bc = t.adj[e1], twin_ad = t.adj[f1];
    t.tri[g] = p;
    t.tri[g + 1] = b;
    t.tri[g + 2] = c;
    t.tri[h] = p;
    t.tri[h + 1] = a;
    t.tri[h + 2] = d;
    t.tri[e1] = p;       // e: a -> p, e1: p -> c
    t.tri[f1] = p;       // f: b -> p, f1: p -> d
    join(t, e, h);       // a -> p meets p -> a
    join(t, f, g);       // b -> p meets p -> b
    join(t, e1, g + 2);  // p -> c meets c -> p
    join(t, f1, h + 2);  // p -> d meets d -> p
    join(t, g + 1, twin_bc);
    join(t, h + 1, twin_ad);
    t.fixed[g + 1] = t.fixed[e1];
    t.fixed[h + 1] = t.fixed[f1];
    t.fixed[e1] = t.fixed[f1] = 0;
    return p;
}

Vertex split_long_edges(Triangulation& t, SurfaceFrames& s, VertexMarks& marks, double longest) {
    const Vertex first = t.vertices();
    const Triangle end = t.triangles();
    const auto split_edges_of = [&](Triangle k) {
        if (t.region[k] == DEAD || !is_active(t, marks, k)) return;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e)
            if (is_long(t, s, marks, e, first, longest)) halve(t, s, marks, e);
    };
    if (t.parts.empty()) {
        for (Triangle k = 0; k < end; ++k) split_edges_of(k);
    } else {
        for (const Triangle k : with_long_edge(t, s, marks, longest)) split_edges_of(k);
    }
    return first;
}

Vertex split_far_edges(Triangulation& t, SurfaceFrames& s, VertexMarks& marks,
                       std::span<const Triangle> triangles) {
    const Vertex first = t.vertices();
    for (const Triangle k : triangles) {
        const HalfEdge e = farthest_edge(t, s, k, first);
        if (e != NIL) halve(t, s, marks, e);
    }
    return first;
}

}  // namespace surfmesh
