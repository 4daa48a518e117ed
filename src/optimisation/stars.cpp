#include "optimisation/stars.hpp"

namespace surfmesh {

void find_stars(const Triangulation& t, Stars& stars) {
    stars.start.resize(t.xy.size());
    stars.frozen.resize(t.xy.size());
    stars.degree.resize(t.xy.size());
    stars.start.fill(NIL);
    stars.frozen.fill(0);
    stars.degree.fill(0);
    for (Triangle k = 0; k < t.triangles(); ++k) {
        if (t.region[k] == DEAD) continue;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
            const Vertex v = t.tri[e];
            stars.start[v] = e;
            stars.degree[v] += 1;
            if (t.adj[e] < 0 || (t.has_segments() && t.fixed[e] != 0)) {
                stars.frozen[v] = 1;
                stars.frozen[t.tri[next_half_edge(e)]] = 1;
            }
        }
    }
}

}  // namespace surfmesh
