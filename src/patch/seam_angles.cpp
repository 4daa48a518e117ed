#include "patch/seam_angles.hpp"

#include <algorithm>
#include <tuple>

namespace surfmesh {
namespace {

/// A half-edge of the border, with its ends after identification, the smaller first.
struct BorderEdge {
    Vertex low, high;
    HalfEdge edge;
};

bool is_flat(const Triangulation& t, const Array<Vertex>& number, Triangle k) {
    const Vertex a = number[t.tri[3 * k]], b = number[t.tri[3 * k + 1]];
    const Vertex c = number[t.tri[3 * k + 2]];
    return a == b || b == c || c == a;
}

/// Half-edges without a twin, and those that look at a triangle that is an edge in space.
Array<HalfEdge> border_in_space(const Triangulation& t, const Array<Vertex>& number) {
    Array<HalfEdge> border, beyond;
    for (Triangle k = 0; k < t.triangles(); ++k) {
        if (t.region[k] == DEAD) continue;
        const bool flat = is_flat(t, number, k);
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
            if (t.adj[e] < 0) {
                if (!flat) border.push_back(e);
            } else if (flat && !is_flat(t, number, t.adj[e] / 3)) {
                beyond.push_back(t.adj[e]);
            }
        }
    }
    for (const HalfEdge e : beyond) border.push_back(e);
    return border;
}

}  // namespace

DihedralAngles dihedrals_across_seams(const Triangulation& t, const Array<Point3>& point,
                                      const Array<Vertex>& number) {
    Array<BorderEdge> edges;
    for (const HalfEdge e : border_in_space(t, number)) {
        const Vertex a = number[t.tri[e]], b = number[t.tri[next_half_edge(e)]];
        if (a != b)  // not a side that is one point
            edges.push_back({std::min(a, b), std::max(a, b), e});
    }
    std::stable_sort(edges.begin(), edges.end(), [](const BorderEdge& p, const BorderEdge& q) {
        return std::tie(p.high, p.low) < std::tie(q.high, q.low);
    });
    DihedralAngles found;
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        const BorderEdge &p = edges[k], &q = edges[k + 1];
        if (p.low == q.low && p.high == q.high) found.edges.push_back({p.edge, q.edge});
    }
    found.angles = dihedral_angles(point, t.tri, found.edges);
    return found;
}

}  // namespace surfmesh
