#include "optimisation/stars.hpp"

#include "triangulation/parts.hpp"

namespace surfmesh {
namespace {

void add_triangle(const Triangulation& t, Triangle k, Stars& stars) {
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

void clear(const Triangulation& t, Stars& stars) {
    stars.start.resize(t.xy.size());
    stars.frozen.resize(t.xy.size());
    stars.degree.resize(t.xy.size());
    stars.shared.resize(t.parts.empty() ? 0 : t.xy.size());
    stars.start.fill(NIL);
    stars.frozen.fill(0);
    stars.degree.fill(0);
    stars.shared.fill(0);
}

}  // namespace

void find_stars(const Triangulation& t, Stars& stars) {
    clear(t, stars);
    const Array<Triangle> left = for_each_part(t, [&](const Part& part, Array<Triangle>& later) {
        for (Triangle k = part.first_triangle; k < part.end_triangle; ++k) {
            if (t.region[k] == DEAD) continue;
            if (is_within(t, part, k))
                add_triangle(t, k, stars);
            else
                later.push_back(k);
        }
    });
    for (const Triangle k : left) {
        if (t.region[k] == DEAD) continue;
        add_triangle(t, k, stars);
        const Vertex a = t.tri[3 * k], b = t.tri[3 * k + 1], c = t.tri[3 * k + 2];
        if (!are_in_one_part(t, a, b, c)) stars.shared[a] = stars.shared[b] = stars.shared[c] = 1;
    }
}

}  // namespace surfmesh
