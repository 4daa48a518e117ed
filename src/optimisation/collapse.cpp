#include "optimisation/collapse.hpp"

#include "triangulation/local_operations.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t COLLAPSES_TOGETHER = 1 << 13;  // vertices looked at together

bool has_short_edge(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start,
                    double shortest) {
    HalfEdge e = start;
    do {
        const Vertex p = t.tri[next_half_edge(e)];
        if (!is_longer(s, v, p, shortest) && edge_length(s, v, p) < shortest) return true;
        e = rotate_ccw(t, e);
    } while (e != start);
    return false;
}

}  // namespace

int collapse_short_edges(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                         double shortest, int few) {
    const Array<Vertex> found = collect_by_blocks<Vertex>(
        t.xy.size(), COLLAPSES_TOGETHER,
        [&](std::size_t first, std::size_t last, Array<Vertex>& own) {
            for (auto v = static_cast<Vertex>(first); v < static_cast<Vertex>(last); ++v) {
                const HalfEdge start = stars.start[v];
                if (start == NIL || stars.frozen[v] != 0) continue;
                if (stars.degree[v] <= few || has_short_edge(t, s, v, start, shortest))
                    own.push_back(v);
            }
        });
    Array<std::uint8_t> stale(t.xy.size(), 0);  // a neighbour has just gone
    int removed = 0;
    for (const Vertex v : found) {
        const HalfEdge start = stars.start[v];
        if (stale[v]) continue;
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
