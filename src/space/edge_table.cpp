#include "space/edge_table.hpp"

#include <algorithm>
#include <tuple>

namespace surfmesh {
namespace {

constexpr std::int64_t SPARSE = 8;  // times as many vertices as corners: they are not counted

struct EdgeUse {
    Vertex lower, higher;
    std::int32_t half_edge;
};

bool is_before(const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.lower, a.higher, a.half_edge) < std::tie(b.lower, b.higher, b.half_edge);
}

/// Those of one lower vertex, which come in the order of half-edges: mostly three to six.
void sort_by_higher(std::span<EdgeUse> uses) {
    constexpr std::size_t FEW = 32;
    if (uses.size() > FEW) return std::sort(uses.begin(), uses.end(), is_before);
    for (std::size_t k = 1; k < uses.size(); ++k) {
        const EdgeUse use = uses[k];
        std::size_t place = k;
        for (; place > 0 && use.higher < uses[place - 1].higher; --place)
            uses[place] = uses[place - 1];
        uses[place] = use;
    }
}

/// Call work(use) for all half-edges, in their order.
template <class Work>
void for_each_use(std::span<const TriangleCorners> triangles, const Work& work) {
    std::int32_t half_edge = 0;
    for (const TriangleCorners& t : triangles)
        for (const auto& [a, b] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)})
            work(EdgeUse{std::min(a, b), std::max(a, b), half_edge++});
}

/// The half-edges edge by edge: counted by their lower vertex, then sorted at each vertex.
Array<EdgeUse> sorted_uses(std::span<const TriangleCorners> triangles) {
    std::int64_t low = 0, high = 0;
    for_each_use(triangles, [&](const EdgeUse& use) {
        low = std::min<std::int64_t>(low, use.lower);
        high = std::max<std::int64_t>(high, use.higher);
    });
    const auto count = static_cast<std::int64_t>(3 * triangles.size());
    const bool is_sparse = high - low > SPARSE * count;
    const auto place = [&](Vertex v) { return is_sparse ? 0 : v - low; };
    Array<std::size_t> first(is_sparse ? 2 : high - low + 2, 0);
    for_each_use(triangles, [&](const EdgeUse& use) { ++first[place(use.lower) + 1]; });
    for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    Array<std::size_t> next = first;
    Array<EdgeUse> uses(count);
    for_each_use(triangles, [&](const EdgeUse& use) { uses[next[place(use.lower)]++] = use; });
    if (is_sparse)
        std::sort(uses.begin(), uses.end(), is_before);
    else
        for (std::size_t v = 0; v + 1 < first.size(); ++v)
            sort_by_higher({uses.begin() + first[v], uses.begin() + first[v + 1]});
    return uses;
}

/// From where to where a half-edge runs.
std::pair<Vertex, Vertex> ends_of(std::span<const TriangleCorners> triangles, std::int32_t e) {
    const std::span<const Vertex> corners = corners_in_a_row(triangles);
    return {corners[e], corners[e % 3 == 2 ? e - 2 : e + 1]};
}

}  // namespace

EdgeTable edge_table(std::span<const TriangleCorners> triangles) {
    const Array<EdgeUse> uses = sorted_uses(triangles);
    EdgeTable table;
    table.edges.reserve(uses.size() / 2);
    table.half_edges.reserve(uses.size() / 2);
    table.uses.reserve(uses.size() / 2);
    for (std::size_t k = 0; k < uses.size();) {
        const EdgeUse& one = uses[k];
        std::size_t end = k + 1;
        while (end < uses.size() && uses[end].lower == one.lower && uses[end].higher == one.higher)
            ++end;
        table.edges.push_back({one.lower, one.higher});
        table.half_edges.push_back({one.half_edge, end > k + 1 ? uses[k + 1].half_edge : NIL});
        table.uses.push_back(static_cast<std::int32_t>(end - k));
        k = end;
    }
    return table;
}

Array<std::int64_t> edge_rows(std::span<const EdgeTable::Ends> edges,
                              std::span<const EdgeTable::Ends> pairs) {
    Array<std::int64_t> rows(pairs.size(), NIL);
    if (edges.empty()) return rows;
    // edges by their lower vertex; where the numbers are sparse, all of them together
    const std::int64_t low = edges.front().lower, high = edges.back().lower;
    const auto count = static_cast<std::int64_t>(edges.size() + pairs.size());
    const bool is_sparse = high - low > SPARSE * count;
    const auto place = [&](Vertex v) { return is_sparse ? 0 : v - low; };
    Array<std::size_t> first(is_sparse ? 2 : high - low + 2, 0);
    for (const auto& edge : edges) ++first[place(edge.lower) + 1];
    for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto [a, b] = pairs[k];
        const EdgeTable::Ends pair{std::min(a, b), std::max(a, b)};
        if (pair.lower < low || pair.lower > high) continue;
        const std::size_t begin = first[place(pair.lower)], end = first[place(pair.lower) + 1];
        const auto near = edges.subspan(begin, end - begin);
        const auto there = std::lower_bound(near.begin(), near.end(), pair);
        if (there != near.end() && *there == pair)
            rows[k] = static_cast<std::int64_t>(begin) + (there - near.begin());
    }
    return rows;
}

Array<std::int32_t> opposite_half_edges(std::span<const TriangleCorners> triangles,
                                        std::span<const EdgeTable::Sides> sides) {
    const auto count = static_cast<std::int32_t>(3 * triangles.size());
    Array<std::int32_t> opposite(3 * triangles.size(), NIL);
    for (const auto& [e, f] : sides) {
        if (e < 0 || f < 0 || e >= count || f >= count || e == f) continue;
        const auto [a, b] = ends_of(triangles, e);
        if (opposite[e] != NIL || opposite[f] != NIL || std::pair(b, a) != ends_of(triangles, f))
            continue;
        opposite[e] = f;
        opposite[f] = e;
    }
    return opposite;
}

}  // namespace surfmesh
