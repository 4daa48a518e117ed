#include "quality/triangle_fans.hpp"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

namespace surfmesh {
namespace {

/// Corners that hang together, each called by the smallest.
class JoinedCorners {
  public:
    explicit JoinedCorners(std::size_t corners) : parent_(corners) {
        for (std::size_t k = 0; k < corners; ++k) parent_[k] = static_cast<std::int32_t>(k);
    }
    std::int32_t root(std::int32_t a) {
        while (parent_[a] != a) {
            parent_[a] = parent_[parent_[a]];
            a = parent_[a];
        }
        return a;
    }
    void join(std::int32_t a, std::int32_t b) {
        const std::int32_t p = root(a), q = root(b);
        parent_[std::max(p, q)] = std::min(p, q);
    }
    [[nodiscard]] bool is_root(std::int32_t a) const { return parent_[a] == a; }

  private:
    Array<std::int32_t> parent_;
};

/// Where half-edge e starts: its corner.
Vertex start_of_half_edge(std::span<const TriangleCorners> triangles, std::int32_t e) {
    return corners_in_a_row(triangles)[e];
}

/// The half-edge after e in its triangle.
std::int32_t following(std::int32_t e) { return e % 3 == 2 ? e - 2 : e + 1; }
/// The one before it.
std::int32_t preceding(std::int32_t e) { return e % 3 == 0 ? e + 2 : e - 1; }

/// How many corners there are at a vertex where e starts, from neighbour to neighbour.
///
/// twins: of each half-edge the one that runs along the same edge the other way, or NIL.
std::int32_t corners_around(std::int32_t e, const Array<std::int32_t>& twins) {
    std::int32_t count = 1;
    std::int32_t corner = twins[preceding(e)];
    for (; corner != NIL && corner != e; corner = twins[preceding(corner)]) ++count;
    if (corner == e) return count;
    for (std::int32_t twin = twins[e]; twin != NIL; twin = twins[following(twin)]) ++count;
    return count;
}

/// One fan at each vertex that has triangles, if neighbours lead from each corner to all others
/// there: so it is at most vertices of most meshes. Else nothing.
std::optional<Array<std::int64_t>> single_fans(std::span<const TriangleCorners> triangles,
                                               std::size_t vertices,
                                               std::span<const EdgeTable::Sides> sides) {
    const Array<std::int32_t> twins = opposite_half_edges(triangles, sides);
    Array<std::int32_t> corners(vertices, 0), one(vertices, NIL);
    for (std::int32_t e = 0; e < static_cast<std::int32_t>(3 * triangles.size()); ++e) {
        const Vertex v = start_of_half_edge(triangles, e);
        ++corners[v];
        one[v] = e;
    }
    Array<std::int64_t> fans(vertices, 0);
    for (std::size_t v = 0; v < vertices; ++v) {
        if (one[v] == NIL) continue;
        if (corners_around(one[v], twins) != corners[v]) return std::nullopt;
        fans[v] = 1;
    }
    return fans;
}

constexpr std::size_t COMPARED_IN_PAIRS = 8;  // things that are compared pair by pair

/// Are two of a few things alike, by a key?
template <class Thing, class Key>
bool has_two_alike(std::span<const Thing> things, const Key& key) {
    for (std::size_t k = 1; k < things.size(); ++k)
        for (std::size_t j = 0; j < k; ++j)
            if (key(things[j]) == key(things[k])) return true;
    return false;
}

}  // namespace

Array<std::int64_t> triangle_fans(std::span<const TriangleCorners> triangles, std::size_t vertices,
                                  std::span<const EdgeTable::Sides> sides) {
    if (auto single = single_fans(triangles, vertices, sides)) return *single;
    JoinedCorners corners(3 * triangles.size());
    for (const auto& [e, f] : sides) {
        if (f == NIL) continue;
        const bool same = start_of_half_edge(triangles, e) == start_of_half_edge(triangles, f);
        corners.join(e, same ? f : following(f));
        corners.join(following(e), same ? following(f) : f);
    }
    Array<std::int64_t> fans(vertices, 0);
    for (std::int32_t k = 0; k < static_cast<std::int32_t>(3 * triangles.size()); ++k)
        if (corners.is_root(k)) ++fans[start_of_half_edge(triangles, k)];
    return fans;
}

Array<std::int32_t> clashing_edges(std::span<const TriangleCorners> triangles,
                                   std::span<const EdgeTable::Sides> sides,
                                   std::span<const std::int32_t> uses) {
    Array<std::int32_t> clashing;
    for (std::size_t k = 0; k < sides.size(); ++k) {
        const auto [e, f] = sides[k];
        if (uses[k] == 2 && f != NIL &&
            start_of_half_edge(triangles, e) == start_of_half_edge(triangles, f))
            clashing.push_back(static_cast<std::int32_t>(k));
    }
    return clashing;
}

Vertex unused_vertex(std::span<const TriangleCorners> triangles, std::size_t vertices) {
    Array<std::uint8_t> is_used(vertices, 0);
    for (const TriangleCorners& t : triangles)
        for (const Vertex v : {t.a, t.b, t.c}) is_used[v] = 1;
    const std::uint8_t* const unused = std::find(is_used.begin(), is_used.end(), 0);
    return unused == is_used.end() ? NIL : static_cast<Vertex>(unused - is_used.begin());
}

bool has_repeated_triangles(std::span<const TriangleCorners> triangles, std::size_t vertices) {
    using Others = std::pair<Vertex, Vertex>;  // of a triangle, without its lowest corner
    const auto sorted = [](const TriangleCorners& t) {
        const Vertex low = std::min({t.a, t.b, t.c}), high = std::max({t.a, t.b, t.c});
        const std::int64_t middle = std::int64_t{t.a} + t.b + t.c - low - high;
        return std::tuple(low, static_cast<Vertex>(middle), high);
    };
    Array<std::size_t> first(vertices + 1, 0);
    for (const TriangleCorners& t : triangles) ++first[std::min({t.a, t.b, t.c}) + 1];
    for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
    Array<std::size_t> next = first;
    struct Corners {
        Vertex middle, high;
    };
    Array<Corners> members(triangles.size());
    for (const TriangleCorners& t : triangles) {
        const auto [low, middle, high] = sorted(t);
        members[next[low]++] = {middle, high};
    }
    const auto key = [](const Corners& c) { return Others(c.middle, c.high); };
    for (std::size_t v = 0; v < vertices; ++v) {
        const std::span<Corners> here{members.data() + first[v], first[v + 1] - first[v]};
        if (here.size() <= COMPARED_IN_PAIRS) {
            if (has_two_alike(std::span<const Corners>(here), key)) return true;
            continue;
        }
        std::sort(here.begin(), here.end(),
                  [&](const Corners& a, const Corners& b) { return key(a) < key(b); });
        for (std::size_t k = 1; k < here.size(); ++k)
            if (key(here[k - 1]) == key(here[k])) return true;
    }
    return false;
}

}  // namespace surfmesh
