#include "faces/boundary_builder.hpp"

namespace surfmesh {

void BoundaryBuilder::add(const EdgeNodeRows& nodes, const EdgeUse& use) {
    const std::size_t count = nodes.uv.size();
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = use.is_reversed ? count - 1 - k : k;
        made_.uv.push_back(nodes.uv[at]);
        made_.numbers.push_back(nodes.numbers[at]);
        made_.points.push_back(nodes.points[at]);
        made_.sizes.push_back(nodes.sizes[at]);
    }
    made_.piece_end.push_back(static_cast<std::int32_t>(made_.uv.size()));
    made_.degenerate.push_back(use.is_degenerate ? 1 : 0);
    made_.tolerance.push_back(use.tolerance);
}

std::vector<FaceBoundary> boundaries_of(const CoedgeRows& rows) {
    std::vector<FaceBoundary> found;
    found.reserve(rows.loops.size());
    std::size_t loop = 0, coedge = 0;
    for (const std::int32_t loops : rows.loops) {
        BoundaryBuilder builder;
        for (std::int32_t l = 0; l < loops; ++l, ++loop) {
            for (std::int32_t c = 0; c < rows.coedges[loop]; ++c, ++coedge) {
                const auto start = static_cast<std::size_t>(rows.first[coedge]);
                const std::size_t count = static_cast<std::size_t>(rows.first[coedge + 1]) - start;
                const auto& [uv, numbers, points, sizes] = rows.nodes;
                builder.add({uv.subspan(start, count), numbers.subspan(start, count),
                             points.subspan(start, count), sizes.subspan(start, count)},
                            {rows.is_reversed[coedge] != 0, rows.is_degenerate[coedge] != 0,
                             rows.tolerance[coedge]});
            }
            builder.end_loop();
        }
        found.push_back(builder.boundary());
    }
    return found;
}

}  // namespace surfmesh
