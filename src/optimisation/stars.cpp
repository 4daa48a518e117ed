#include "optimisation/stars.hpp"

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include "triangulation/parts.hpp"
#include "values/first_touch.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t STARS_TOGETHER = 1 << 10;  // whose triangles are found together
constexpr std::size_t ROOM_FOR_SPLITS = 4;       // this part of the vertices more

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

/// Of ``size`` values, whatever they are, with room for those of vertices that splits add.
template <class T>
void resize_unfilled(Array<T>& values, std::size_t size) {
    if (values.empty()) values = unfilled_with_room<T>(size, size + size / ROOM_FOR_SPLITS);
    values.resize(size);
}

void resize(const Triangulation& t, Stars& stars) {
    resize_unfilled(stars.start, t.xy.size());
    resize_unfilled(stars.frozen, t.xy.size());
    resize_unfilled(stars.degree, t.xy.size());
    resize_unfilled(stars.shared, t.parts.empty() ? 0 : t.xy.size());
}

/// Forget the stars of vertices from ``first`` to ``end``.
void clear(Stars& stars, Vertex first, Vertex end) {
    std::fill(stars.start.begin() + first, stars.start.begin() + end, NIL);
    std::fill(stars.frozen.begin() + first, stars.frozen.begin() + end, std::uint8_t{0});
    std::fill(stars.degree.begin() + first, stars.degree.begin() + end, 0);
    if (stars.shared.empty()) return;
    std::fill(stars.shared.begin() + first, stars.shared.begin() + end, std::uint8_t{0});
}

/// Add the triangles around some vertices; false where a walk does not come to all of them.
bool add_triangles_around(const Triangulation& t, const Stars& stars,
                          std::span<const Vertex> vertices, Array<Triangle>& found) {
    for (const Vertex v : vertices) {
        if (stars.start[v] == NIL) continue;
        const std::size_t before = found.size();
        for_each_in_fan(t, stars.start[v], [&](HalfEdge e) { found.push_back(e / 3); });
        if (static_cast<std::int32_t>(found.size() - before) != stars.degree[v]) return false;
    }
    return true;
}

/// Add numbers in their order to others. Neighbours have numbers near each other: few overlap.
void merge_into(Array<Triangle>& all, const Array<Triangle>& some) {
    if (some.empty()) return;
    const auto before = static_cast<std::ptrdiff_t>(all.size());
    const std::ptrdiff_t overlap =
        std::lower_bound(all.begin(), all.end(), *some.begin()) - all.begin();
    for (const Triangle k : some) all.push_back(k);
    std::inplace_merge(all.begin() + overlap, all.begin() + before, all.end());
}

}  // namespace

void find_stars(const Triangulation& t, Stars& stars) {
    resize(t, stars);
    const Array<Triangle> left = for_each_part(t, [&](const Part& part, Array<Triangle>& later) {
        clear(stars, part.first_vertex, part.end_vertex);
        for (Triangle k = part.first_triangle; k < part.end_triangle; ++k) {
            if (t.region[k] == DEAD) continue;
            if (is_within(t, part, k))
                add_triangle(t, k, stars);
            else
                later.push_back(k);
        }
    });
    clear(stars, part_of(t, count_parts(t) - 1).end_vertex, t.vertices());
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
    std::vector<Array<Triangle>> found((vertices.size() + STARS_TOGETHER - 1) / STARS_TOGETHER);
    std::atomic<bool> complete = true;
    for_each_block(vertices.size(), STARS_TOGETHER, [&](std::size_t first, std::size_t last) {
        Array<Triangle> own;
        const bool all = add_triangles_around(t, stars, vertices.subspan(first, last - first), own);
        if (!all) complete = false;
        std::sort(own.begin(), own.end());
        found[first / STARS_TOGETHER].swap(own);
    });
    if (!complete) return {};
    Array<Triangle> all;
    for (const Array<Triangle>& some : found) merge_into(all, some);
    all.resize(static_cast<std::size_t>(std::unique(all.begin(), all.end()) - all.begin()));
    return all;
}

}  // namespace surfmesh
