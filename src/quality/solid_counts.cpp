#include "quality/solid_counts.hpp"

#include <algorithm>
#include <tuple>

namespace surfmesh {
namespace {

/// A use of an edge by a triangle of a solid, seen from the edge's lower vertex.
struct EdgeUse {
    std::int32_t solid;
    Vertex higher;
    std::int32_t way;  // 1 when it runs upwards, -1 when down
};

/// What belongs to vertices, vertex by vertex: counted first, then filled in.
template <class T>
class AtVertices {
  public:
    explicit AtVertices(std::size_t vertices) : first_(vertices + 1, 0) {}

    void count(Vertex v) { ++first_[v + 1]; }
    void close() {
        for (std::size_t v = 0; v + 1 < first_.size(); ++v) first_[v + 1] += first_[v];
        next_ = first_;
        members_.resize(first_[first_.size() - 1]);
    }
    void add(Vertex v, const T& value) { members_[next_[v]++] = value; }
    [[nodiscard]] std::span<T> of(std::size_t v) {
        return {members_.data() + first_[v], first_[v + 1] - first_[v]};
    }

  private:
    Array<std::size_t> first_, next_;
    Array<T> members_;
};

template <class Work>
void for_each_side(const TriangleCorners& t, const Work& work) {
    work(t.a, t.b);
    work(t.b, t.c);
    work(t.c, t.a);
}

/// Count the edges whose uses these are, all from one lower vertex.
void count_edges(std::span<EdgeUse> uses, SolidCounts& counts) {
    const auto key = [](const EdgeUse& use) { return std::tie(use.solid, use.higher); };
    std::sort(uses.begin(), uses.end(),
              [&](const EdgeUse& a, const EdgeUse& b) { return key(a) < key(b); });
    for (std::size_t k = 0; k < uses.size();) {
        const std::size_t first = k;
        std::int32_t balance = 0;
        for (; k < uses.size() && key(uses[k]) == key(uses[first]); ++k) balance += uses[k].way;
        ++counts.edges[uses[first].solid];
        if (balance != 0) ++counts.open_edges[uses[first].solid];
    }
}

}  // namespace

SolidCounts solid_counts(std::span<const TriangleCorners> triangles,
                         std::span<const std::int32_t> solid, std::size_t vertices,
                         std::size_t solids) {
    SolidCounts counts{Array<std::int64_t>(solids, 0), Array<std::int64_t>(solids, 0),
                       Array<std::int64_t>(solids, 0)};
    AtVertices<EdgeUse> uses(vertices);
    AtVertices<std::int32_t> corners(vertices);
    for (const TriangleCorners& t : triangles)
        for_each_side(t, [&](Vertex a, Vertex b) {
            uses.count(std::min(a, b));
            corners.count(a);
        });
    uses.close();
    corners.close();
    for (std::size_t k = 0; k < triangles.size(); ++k)
        for_each_side(triangles[k], [&](Vertex a, Vertex b) {
            uses.add(std::min(a, b), {solid[k], std::max(a, b), a < b ? 1 : -1});
            corners.add(a, solid[k]);
        });
    for (std::size_t v = 0; v < vertices; ++v) {
        count_edges(uses.of(v), counts);
        const std::span<std::int32_t> beside = corners.of(v);
        std::sort(beside.begin(), beside.end());
        for (std::size_t k = 0; k < beside.size(); ++k)
            if (k == 0 || beside[k] != beside[k - 1]) ++counts.vertices[beside[k]];
    }
    return counts;
}

}  // namespace surfmesh
