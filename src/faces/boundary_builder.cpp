#include "faces/boundary_builder.hpp"

namespace surfmesh {

void BoundaryBuilder::reserve(std::size_t nodes, std::size_t uses) {
    made_.uv.reserve(nodes);
    made_.numbers.reserve(nodes);
    made_.points.reserve(nodes);
    made_.sizes.reserve(nodes);
    made_.piece_end.reserve(uses);
    made_.degenerate.reserve(uses);
    made_.tolerance.reserve(uses);
}

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

}  // namespace surfmesh
