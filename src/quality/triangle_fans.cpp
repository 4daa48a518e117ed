#include "quality/triangle_fans.hpp"

#include <algorithm>
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
    const TriangleCorners& t = triangles[e / 3];
    return e % 3 == 0 ? t.a : e % 3 == 1 ? t.b : t.c;
}

/// The half-edge after e in its triangle.
std::int32_t following(std::int32_t e) { return e % 3 == 2 ? e - 2 : e + 1; }

}  // namespace

Array<std::int64_t> triangle_fans(std::span<const TriangleCorners> triangles, std::size_t vertices,
                                  std::span<const EdgeTable::Sides> sides) {
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
        if (here.size() < 2) continue;
        std::sort(here.begin(), here.end(),
                  [&](const Corners& a, const Corners& b) { return key(a) < key(b); });
        for (std::size_t k = 1; k < here.size(); ++k)
            if (key(here[k - 1]) == key(here[k])) return true;
    }
    return false;
}

}  // namespace surfmesh
