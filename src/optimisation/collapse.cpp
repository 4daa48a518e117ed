#include "optimisation/collapse.hpp"

#include "triangulation/local_operations.hpp"

namespace surfmesh {
namespace {

bool has_short_edge(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start,
                    double shortest) {
    HalfEdge e = start;
    do {
        if (edge_length(s, v, t.tri[next_half_edge(e)]) < shortest) return true;
        e = rotate_ccw(t, e);
    } while (e != start);
    return false;
}

}  // namespace

int collapse_short_edges(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                         double shortest, int few) {
    Array<std::uint8_t> stale(t.xy.size(), 0);  // a neighbour has just gone
    int removed = 0;
    for (Vertex v = 0; v < t.vertices(); ++v) {
        const HalfEdge start = stars.start[v];
        if (start == NIL || stars.frozen[v] != 0 || stale[v]) continue;
        if (stars.degree[v] > few && !has_short_edge(t, s, v, start, shortest)) continue;
        for_each_in_star(t, start, [&](HalfEdge e) { stale[t.tri[next_half_edge(e)]] = 1; });
        if (remove_vertex(t, start) == NIL) continue;
        stars.start[v] = NIL;
        ++removed;
    }
    for (Vertex v = 0; v < t.vertices(); ++v)
        if (stale[v]) marks.touch(v);
    return removed;
}

}  // namespace surfmesh
