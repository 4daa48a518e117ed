// The rules that are asked for on surfaces whose extent is not known yet.
//
// In: rules as surfmesh.sizing.rules.size_rules makes them, and the bounds that are stated. Out: the
// same on a surface of known diagonal.
#pragma once

#include "sizing/size_bounds.hpp"
#include "sizing/size_rules.hpp"

namespace surfmesh {

using CurvatureRules = std::vector<std::shared_ptr<const CurvatureRule>>;

/// Sizes do not depend on the direction.
struct AskedRules {
    CurvatureRules by_curvature;
    CurvatureRules on_lattice;  // the same for triangles that form a lattice, where they may
    std::vector<std::shared_ptr<const PlaceRule>> by_place;
    StatedBounds bounds;
};

/// diagonal: of the surface's bounding box. on_lattice: for triangles that form a lattice.
[[nodiscard]] SizeRules rules_on(const AskedRules& asked, double diagonal, bool on_lattice = false);

/// May triangles form a lattice along principal directions at all?
[[nodiscard]] inline bool may_form_lattice(const AskedRules& asked) {
    return !asked.on_lattice.empty();
}

}  // namespace surfmesh
