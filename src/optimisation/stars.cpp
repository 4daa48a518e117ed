#include "optimisation/stars.hpp"

#include <algorithm>
#include <utility>

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

bool renew_star(const Triangulation& t, HalfEdge e, Stars& stars) {
    const Vertex v = t.tri[e];
    std::pair<bool, HalfEdge> last{false, NIL};  // what is within no part comes last
    std::int32_t found = 0;
    bool is_shared = false;
    for_each_in_fan(t, e, [&](HalfEdge f) {
        const Triangle k = f / 3;
        const bool is_left = !is_within_its_part(t, k);
        last = std::max(last, {is_left, f});
        if (is_left && !are_in_one_part(t, t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2]))
            is_shared = true;
        ++found;
    });
    stars.start[v] = last.second;
    if (!stars.shared.empty()) stars.shared[v] = is_shared ? 1 : 0;
    return found == stars.degree[v];
}

std::optional<Array<Triangle>> triangles_around(const Triangulation& t, const Stars& stars,
                                                std::span<const Vertex> vertices) {
    Array<Triangle> found;
    for (const Vertex v : vertices) {
        if (stars.start[v] == NIL) continue;
        const std::size_t before = found.size();
        for_each_in_fan(t, stars.start[v], [&](HalfEdge e) { found.push_back(e / 3); });
        if (static_cast<std::int32_t>(found.size() - before) != stars.degree[v]) return {};
    }
    std::sort(found.begin(), found.end());
    found.resize(static_cast<std::size_t>(std::unique(found.begin(), found.end()) - found.begin()));
    return found;
}

}  // namespace surfmesh
