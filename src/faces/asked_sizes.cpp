#include "faces/asked_sizes.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "patch/limits.hpp"

namespace surfmesh {

SizeRules rules_on(const AskedSizes& asked, double diagonal, bool on_lattice) {
    SizeRules rules{{}, {}, 0.0, 0.0, 0.0, 1.0};
    const auto follow = [&](auto rule) {
        rules.by_curvature.push_back(std::make_shared<decltype(rule)>(std::move(rule)));
    };
    if (asked.chord && !asked.is_curved)
        follow(ChordRule(*asked.chord, asked.is_width, on_lattice));
    if (asked.chord && asked.is_curved) follow(QuadraticChordRule(*asked.chord));
    if (asked.angle) follow(AngleRule(*asked.angle, FINEST_BY_ANGLE * diagonal));
    if (asked.chord && !asked.angle)
        follow(NormalDeviationRule(asked.default_angle, LEAST_OF_CHORD * *asked.chord));
    if (asked.size) rules.by_place.push_back(std::make_shared<ConstantSize>(*asked.size));
    double coarsest = std::numeric_limits<double>::infinity();
    if (asked.max_size) coarsest = std::min(coarsest, *asked.max_size);
    if (!asked.max_size && !asked.size)
        coarsest = std::min(coarsest, asked.default_largest * diagonal);
    if (asked.size) coarsest = std::min(coarsest, *asked.size);
    const bool has_least = asked.min_size && *asked.min_size > 0.0;
    rules.smallest = has_least ? *asked.min_size : std::min(FINEST_SIZE * diagonal, coarsest);
    rules.largest = rules.longest = std::max(coarsest, rules.smallest);
    return rules;
}

}  // namespace surfmesh
