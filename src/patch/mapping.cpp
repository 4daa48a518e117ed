#include "patch/mapping.hpp"

#include <algorithm>

namespace surfmesh {
namespace {

constexpr std::size_t BLOCK = 1 << 15;  // points put into space together

}  // namespace

MappedPatch map_to_space(PatchState& state, std::span<const Point2> node_uv,
                         const IdentifiedBoundary& boundary) {
    state.end_passes();
    const Triangulation& t = state.t;
    MappedPatch found;
    found.uv = state.chart().to_uv({t.xy.data(), t.xy.size()});
    for (std::size_t k = 0; k < node_uv.size(); ++k) found.uv[state.nodes().vertex[k]] = node_uv[k];
    found.seamless = identify_seams({{t.tri.data(), t.tri.size()},
                                     {t.adj.data(), t.adj.size()},
                                     {t.region.data(), t.region.size()},
                                     t.vertices()},
                                    boundary);
    const std::span<const std::int64_t> vertex{found.seamless.vertex.data(),
                                               found.seamless.vertex.size()};
    found.sizes.reserve(vertex.size());
    found.points.reserve(vertex.size());
    for (std::size_t start = 0; start < vertex.size(); start += BLOCK) {
        Array<Point2> places;
        for (const auto v : vertex.subspan(start, std::min(BLOCK, vertex.size() - start))) {
            const double size = state.background().scalar_size_at(t.xy[v].x, t.xy[v].y);
            found.sizes.push_back(size * state.frames.scale[v]);
            places.push_back(found.uv[v]);
        }
        state.surface().read({places.data(), places.size()}, 0);
        for (const Point3 r : state.surface()[0]) found.points.push_back(r);
    }
    return found;
}

}  // namespace surfmesh
