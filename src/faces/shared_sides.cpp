#include "faces/shared_sides.hpp"

#include <algorithm>
#include <utility>

namespace surfmesh {
namespace {

/// Call work(lower, higher) for each side between two shared vertices.
template <class Work>
void for_each_shared_side(std::span<const TriangleCorners> triangles,
                          std::span<const std::uint8_t> shared, const Work& work) {
    const auto side = [&](Vertex a, Vertex b) {
        if (shared[static_cast<std::size_t>(a)] != 0 && shared[static_cast<std::size_t>(b)] != 0)
            work(std::min(a, b), std::max(a, b));
    };
    for (const auto& [a, b, c] : triangles) side(a, b), side(b, c), side(c, a);
}

}  // namespace

bool has_crowded_side(std::span<const TriangleCorners> triangles,
                      std::span<const std::uint8_t> shared) {
    Array<std::int64_t> first(shared.size() + 1, 0);  // sides in the order of their lower vertex
    for_each_shared_side(triangles, shared, [&](Vertex lower, Vertex) { ++first[lower + 1]; });
    for (std::size_t v = 0; v < shared.size(); ++v) first.data()[v + 1] += first.data()[v];
    Array<Vertex> higher(static_cast<std::size_t>(first.back()));
    Array<std::int64_t> next = first;
    for_each_shared_side(triangles, shared,
                         [&](Vertex lower, Vertex other) { higher[next[lower]++] = other; });
    for (std::size_t v = 0; v < shared.size(); ++v) {
        const std::span own(higher.data() + first.data()[v], higher.data() + first.data()[v + 1]);
        if (own.size() < 3) continue;
        std::sort(own.begin(), own.end());
        for (std::size_t i = 2; i < own.size(); ++i)
            if (own[i - 2] == own[i]) return true;
    }
    return false;
}

Array<std::int64_t> triangles_of_shared(std::span<const TriangleCorners> triangles,
                                        std::span<const std::uint8_t> shared) {
    const auto is_shared = [&](Vertex v) { return shared[static_cast<std::size_t>(v)] != 0; };
    Array<std::int64_t> found;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        if (is_shared(a) && is_shared(b) && is_shared(c))
            found.push_back(static_cast<std::int64_t>(t));
    }
    return found;
}

}  // namespace surfmesh
