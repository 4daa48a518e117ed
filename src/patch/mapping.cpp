#include "patch/mapping.hpp"

namespace surfmesh {

MappedPatch map_to_space(PatchState& state, std::span<const Point2> node_uv,
                         const IdentifiedBoundary& boundary) {
    const Triangulation& t = state.t;
    MappedPatch found;
    found.uv = state.chart().to_uv({t.xy.data(), t.xy.size()});
    for (std::size_t k = 0; k < node_uv.size(); ++k) found.uv[state.nodes().vertex[k]] = node_uv[k];
    found.seamless = identify_seams({{t.tri.data(), t.tri.size()},
                                     {t.adj.data(), t.adj.size()},
                                     {t.region.data(), t.region.size()},
                                     t.vertices()},
                                    boundary);
    Array<Point2> places;
    for (const std::int64_t v : found.seamless.vertex) {
        const double size = state.background().scalar_size_at(t.xy[v].x, t.xy[v].y);
        found.sizes.push_back(size * state.frames.scale[v]);
        places.push_back(found.uv[v]);
    }
    state.surface().read({places.data(), places.size()}, 0);
    found.points = Array<Point3>(state.surface()[0]);
    return found;
}

}  // namespace surfmesh
