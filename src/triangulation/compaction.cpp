#include "triangulation/compaction.hpp"

namespace surfmesh {

DomainTriangulation cut_inside(const Triangulation& t) {
    Array<Triangle> triangle_number(t.region.size(), NIL);
    DomainTriangulation domain{{}, Array<Vertex>(t.xy.size(), NIL)};
    Triangle triangles = 0;
    for (Triangle k = 0; k < t.triangles(); ++k) {
        if (t.region[k] != INSIDE) continue;
        triangle_number[k] = triangles++;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) domain.vertex_number[t.tri[e]] = 0;
    }
    Triangulation& out = domain.t;
    for (Vertex v = 0; v < t.vertices(); ++v)
        if (domain.vertex_number[v] != NIL)
            domain.vertex_number[v] = out.add_vertex(t.xy[v], t.size[v]);
    const std::size_t half_edges = 3 * static_cast<std::size_t>(triangles);
    out.tri.resize(half_edges);
    out.adj.resize(half_edges, NIL);
    out.fixed.resize(half_edges);
    out.region.resize(half_edges / 3, 0);
    out.mark.resize(half_edges / 3, 0);
    for (HalfEdge e = 0; e < 3 * t.triangles(); ++e) {
        const Triangle n = triangle_number[e / 3];
        if (n == NIL) continue;
        const HalfEdge f = 3 * n + e % 3;
        out.tri[f] = domain.vertex_number[t.tri[e]];
        out.fixed[f] = t.fixed[e];
        const HalfEdge twin = t.adj[e];
        const Triangle m = twin >= 0 ? triangle_number[twin / 3] : NIL;
        out.adj[f] = m != NIL ? 3 * m + twin % 3 : NIL;
    }
    return domain;
}

}  // namespace surfmesh
