#include "optimisation/swaps.hpp"

#include "triangulation/local_operations.hpp"

namespace surfmesh {
namespace {

constexpr double SWAP_GAIN = 1e-3;  // smallest betterment of the worse alpha for a swap

/// The corners of the two triangles at an edge that is not on the border: a-b-c and b-a-d.
struct Quadrilateral {
    Vertex a, b, c, d;
};

Quadrilateral corners_around(const Triangulation& t, HalfEdge e) {
    const HalfEdge f = t.adj[e];
    return {t.tri[e], t.tri[f], t.tri[prev_half_edge(e)], t.tri[prev_half_edge(f)]};
}

/// Does the chord from v to p run as the edge in the plane does?
///
/// It does not when the edge goes round a closed surface and the chord takes the short cut.
/// Nothing can be said at a degenerate point.
bool follows(const Triangulation& t, const SurfaceFrames& s, Vertex v, Vertex p) {
    if (is_zero(s.normal[p])) return true;
    const Point2 in_space = chord(s, v, p);
    const Point2 in_plane = solve(t.size[v], t.xy[p] - t.xy[v]);
    return dot(in_space, in_plane) > 0.0 &&
           dot(in_plane, in_plane) < 16.0 * dot(in_space, in_space);
}

/// Is the swap of e valid in the plane, and the new edge short in the plane as in space?
bool may_swap(const Triangulation& t, const SurfaceFrames& s, HalfEdge e) {
    if (!is_convex(t, e)) return false;
    const Quadrilateral q = corners_around(t, e);
    return follows(t, s, q.c, q.d) && follows(t, s, q.d, q.c);
}

void touch(VertexMarks& marks, const Quadrilateral& q) {
    marks.touch(q.a);
    marks.touch(q.b);
    marks.touch(q.c);
    marks.touch(q.d);
}

bool is_dirty(const Triangulation& t, const VertexMarks& marks, Triangle k) {
    return marks.dirty[t.tri[3 * k]] || marks.dirty[t.tri[3 * k + 1]] ||
           marks.dirty[t.tri[3 * k + 2]];
}

/// Swap e if that raises the smaller alpha of its two triangles.
bool swap_if_better(Triangulation& t, const SurfaceFrames& s, Array<double>& shape,
                    VertexMarks& marks, HalfEdge e) {
    const HalfEdge f = t.adj[e];
    if (f < 0 || t.fixed[e] != 0) return false;
    const Quadrilateral q = corners_around(t, e);
    const double old = std::min(shape[e / 3], shape[f / 3]);
    const double first = triangle_shape(s, q.a, q.d, q.c);
    const double second = triangle_shape(s, q.b, q.c, q.d);
    if (!(std::min(first, second) > old + SWAP_GAIN) || !may_swap(t, s, e)) return false;
    swap_edge(t, e);
    shape[e / 3] = first;
    shape[f / 3] = second;
    touch(marks, q);
    return true;
}

}  // namespace

int swap_for_shape(Triangulation& t, const SurfaceFrames& s, Array<double>& shape,
                   VertexMarks& marks, double good, int sweeps) {
    shape.resize(t.region.size(), 1.0);
    for (Triangle k = 0; k < t.triangles(); ++k)
        if (t.region[k] != DEAD && is_dirty(t, marks, k))
            shape[k] = triangle_shape(s, t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2]);
    int total = 0;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        int swaps = 0;
        for (Triangle k = 0; k < t.triangles(); ++k) {
            if (shape[k] > good || t.region[k] == DEAD || !is_dirty(t, marks, k)) continue;
            for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e)
                swaps += swap_if_better(t, s, shape, marks, e);
        }
        total += swaps;
        if (swaps == 0) break;
    }
    marks.dirty.fill(0);
    return total;
}

int swap_for_degree(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                    double least) {
    Array<std::int32_t>& degree = stars.degree;
    int swaps = 0;
    for (HalfEdge e = 0; e < 3 * t.triangles(); ++e) {
        if (t.adj[e] <= e || t.fixed[e] != 0 || t.region[e / 3] == DEAD) continue;
        const Quadrilateral q = corners_around(t, e);
        const int inner = degree[q.a] + degree[q.b];
        if (inner < 13 || inner - degree[q.c] - degree[q.d] < 3) continue;
        if (stars.frozen[q.a] || stars.frozen[q.b] || stars.frozen[q.c] || stars.frozen[q.d])
            continue;
        if (!(triangle_shape(s, q.a, q.d, q.c) > least)) continue;
        if (!(triangle_shape(s, q.b, q.c, q.d) > least) || !may_swap(t, s, e)) continue;
        swap_edge(t, e);
        degree[q.a] -= 1;
        degree[q.b] -= 1;
        degree[q.c] += 1;
        degree[q.d] += 1;
        touch(marks, q);
        ++swaps;
    }
    return swaps;
}

}  // namespace surfmesh
