#include "sizing/asked_rules.hpp"

namespace surfmesh {

SizeRules rules_on(const AskedRules& asked, double diagonal, bool on_lattice) {
    CurvatureRules by_curvature = on_lattice ? asked.on_lattice : asked.by_curvature;
    for (auto& rule : by_curvature)
        if (auto other = rule->on_extent(diagonal)) rule = std::move(other);
    const SizeBounds bounds = size_bounds(asked.bounds, diagonal);
    return {std::move(by_curvature), asked.by_place, bounds.smallest,
            bounds.largest,          bounds.longest, 1.0};
}

}  // namespace surfmesh
