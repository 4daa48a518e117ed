#include "quality/mesh_edges.hpp"

namespace surfmesh {

Array<EdgeSides> edges_of_faces(std::span<const EdgeTable::Sides> half_edges,
                                std::span<const std::int32_t> faces) {
    Array<EdgeSides> seen, again;
    seen.reserve(half_edges.size());
    for (const auto& [first, second] : half_edges) {
        const bool is_between = second != NIL && faces[first / 3] != faces[second / 3];
        seen.push_back({first, is_between ? NIL : second});
        if (is_between) again.push_back({second, NIL});
    }
    for (const EdgeSides& sides : again) seen.push_back(sides);
    return seen;
}

}  // namespace surfmesh
