#include "quality/solid_counts.hpp"

#include <algorithm>
#include <cstdint>

namespace surfmesh {
namespace {

/// A use of an edge by a triangle of a solid, seen from the edge's lower vertex, as one number in
/// the order of solids, then of higher vertices; the last bit says whether it runs upwards.
using EdgeUse = std::uint64_t;

EdgeUse edge_use(std::int32_t solid, Vertex a, Vertex b) {
    const auto higher = static_cast<std::uint64_t>(std::max(a, b));
    return static_cast<std::uint64_t>(solid) << 33 | higher << 1 | (a < b ? 1U : 0U);
}
std::uint64_t edge_of(EdgeUse use) { return use >> 1; }
std::int32_t solid_of(EdgeUse use) { return static_cast<std::int32_t>(use >> 33); }

/// The uses of edges at their lower vertices: counted first, then filled in.
class UsesAtVertices {
  public:
    explicit UsesAtVertices(std::size_t vertices) : first_(vertices + 1, 0) {}

    void count(Vertex v) { ++first_[v + 1]; }
    void close() {
        for (std::size_t v = 0; v + 1 < first_.size(); ++v) first_[v + 1] += first_[v];
        next_ = first_;
        members_.resize(first_[first_.size() - 1]);
    }
    void add(Vertex v, EdgeUse use) { members_[next_[v]++] = use; }
    [[nodiscard]] std::span<EdgeUse> of(std::size_t v) {
        return {members_.data() + first_[v], first_[v + 1] - first_[v]};
    }

  private:
    Array<std::size_t> first_, next_;
    Array<EdgeUse> members_;
};

/// The vertices of each solid: as a rule one has one, so only others are remembered one by one.
void count_vertices(std::span<const TriangleCorners> triangles, std::span<const std::int32_t> solid,
                    std::size_t vertices, Array<std::int64_t>& counts) {
    Array<std::int32_t> own(vertices, NIL);
    Array<std::uint64_t> others;  // vertex, solid
    for (std::size_t k = 0; k < triangles.size(); ++k)
        for (const Vertex v : {triangles[k].a, triangles[k].b, triangles[k].c}) {
            if (own[v] == NIL) {
                own[v] = solid[k];
                ++counts[solid[k]];
            } else if (own[v] != solid[k]) {
                others.push_back(static_cast<std::uint64_t>(v) << 32 |
                                 static_cast<std::uint64_t>(solid[k]));
            }
        }
    std::sort(others.begin(), others.end());
    for (std::size_t k = 0; k < others.size(); ++k)
        if (k == 0 || others[k] != others[k - 1])
            ++counts[static_cast<std::int32_t>(others[k] & 0xFFFFFFFFU)];
}

template <class Work>
void for_each_side(const TriangleCorners& t, const Work& work) {
    work(t.a, t.b);
    work(t.b, t.c);
    work(t.c, t.a);
}

/// Count the edges whose uses these are, all from one lower vertex.
void count_edges(std::span<EdgeUse> uses, SolidCounts& counts) {
    std::sort(uses.begin(), uses.end());
    for (std::size_t k = 0; k < uses.size();) {
        const std::size_t first = k;
        std::int64_t balance = 0;
        for (; k < uses.size() && edge_of(uses[k]) == edge_of(uses[first]); ++k)
            balance += (uses[k] & 1U) != 0 ? 1 : -1;
        ++counts.edges[solid_of(uses[first])];
        if (balance != 0) ++counts.open_edges[solid_of(uses[first])];
    }
}

}  // namespace

SolidCounts solid_counts(std::span<const TriangleCorners> triangles,
                         std::span<const std::int32_t> solid, std::size_t vertices,
                         std::size_t solids) {
    SolidCounts counts{Array<std::int64_t>(solids, 0), Array<std::int64_t>(solids, 0),
                       Array<std::int64_t>(solids, 0)};
    UsesAtVertices uses(vertices);
    for (const TriangleCorners& t : triangles)
        for_each_side(t, [&](Vertex a, Vertex b) { uses.count(std::min(a, b)); });
    uses.close();
    for (std::size_t k = 0; k < triangles.size(); ++k)
        for_each_side(triangles[k], [&](Vertex a, Vertex b) {
            uses.add(std::min(a, b), edge_use(solid[k], a, b));
        });
    for (std::size_t v = 0; v < vertices; ++v) count_edges(uses.of(v), counts);
    count_vertices(triangles, solid, vertices, counts.vertices);
    return counts;
}

}  // namespace surfmesh
