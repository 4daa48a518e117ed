#include "quality/surface_topology.hpp"

#include "quality/triangle_fans.hpp"
#include "space/measure.hpp"

namespace surfmesh {
namespace {

/// The half-edges that join their triangles: of edges of two triangles, and chains of others.
Array<EdgeTable::Sides> joining_sides(const JoinedTriangles& mesh,
                                      std::span<const EdgeTable::Sides> chains) {
    Array<EdgeTable::Sides> sides;
    for (std::size_t k = 0; k < mesh.half_edges.size(); ++k)
        if (mesh.uses[k] == 2) sides.push_back(mesh.half_edges[k]);
    for (const EdgeTable::Sides& pair : chains) sides.push_back(pair);
    return sides;
}

std::int64_t count_components(const JoinedTriangles& mesh, const Array<std::int64_t>& fans) {
    static_assert(sizeof(ThingPair) == sizeof(EdgeTable::Ends));
    const std::span<const ThingPair> pairs{reinterpret_cast<const ThingPair*>(mesh.edges.data()),
                                           mesh.edges.size()};
    const Array<std::int32_t> labels = component_labels(mesh.points.size(), pairs);
    std::int64_t count = 0;
    for (std::size_t v = 0; v < labels.size(); ++v)
        count += fans[v] > 0 && labels[v] == static_cast<std::int32_t>(v) ? 1 : 0;
    return count;
}

}  // namespace

SurfaceTopology surface_topology(const JoinedTriangles& mesh,
                                 std::span<const EdgeTable::Sides> chains) {
    SurfaceTopology found;
    for (std::size_t k = 0; k < mesh.uses.size(); ++k) {
        found.boundary_edges += mesh.uses[k] == 1 ? 1 : 0;
        if (mesh.uses[k] > 2) found.crowded.push_back(static_cast<std::int32_t>(k));
    }
    if (found.crowded.empty()) {
        found.fans = triangle_fans(mesh.triangles, mesh.points.size(), mesh.half_edges);
    } else {
        const Array<EdgeTable::Sides> sides = joining_sides(mesh, chains);
        found.fans =
            triangle_fans(mesh.triangles, mesh.points.size(), {sides.data(), sides.size()});
    }
    for (std::size_t v = 0; v < found.fans.size(); ++v) {
        found.vertices += found.fans[v] > 0 ? 1 : 0;
        if (found.fans[v] > 1) found.pinched.push_back(static_cast<std::int32_t>(v));
    }
    found.components = count_components(mesh, found.fans);
    found.clashing = clashing_edges(mesh.triangles, mesh.half_edges, mesh.uses);
    return found;
}

}  // namespace surfmesh
