#include "patch/mapping.hpp"

#include <algorithm>

namespace surfmesh {
namespace {

constexpr std::size_t POINTS_TOGETHER = 1 << 12;  // points put into space together

}  // namespace

MappedPatch map_to_space(PatchState& state, std::span<const Point2> node_uv,
                         const IdentifiedBoundary& boundary) {
    state.end_passes();
    const Triangulation& t = state.t;
    MappedPatch found;
    found.uv = Array<Point2>::unfilled(t.xy.size());
    for_each_block(t.xy.size(), POINTS_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (std::size_t v = first; v < last; ++v) found.uv[v] = state.chart().to_uv(t.xy[v]);
    });
    for (std::size_t k = 0; k < node_uv.size(); ++k) found.uv[state.nodes().vertex[k]] = node_uv[k];
    found.seamless = identify_seams({t.tri, t.adj, t.region, t.vertices()}, boundary);
    const std::span<const std::int64_t> vertex{found.seamless.vertex.data(),
                                               found.seamless.vertex.size()};
    found.sizes = Array<double>::unfilled(vertex.size());
    found.points = Array<Point3>::unfilled(vertex.size());
    state.surface().for_each_block(
        vertex.size(), POINTS_TOGETHER,
        [&](SurfaceReader& reader, std::size_t first, std::size_t last) {
            Array<Point2> places;
            for (std::size_t k = first; k < last; ++k) {
                const std::int64_t v = vertex[k];
                const double size = state.background().scalar_size_at(t.xy[v].x, t.xy[v].y);
                found.sizes[k] = size * state.frames.scale[v];
                places.push_back(found.uv[v]);
            }
            reader.read(places, 0);
            std::copy(reader[0].begin(), reader[0].end(), found.points.data() + first);
        });
    return found;
}

}  // namespace surfmesh
