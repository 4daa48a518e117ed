// The size that bounds those inside a plane or a cylinder, which grow inward from the edges.
//
//     box of the boundary -> diagonal -> rules -> by the one curvature -> largest
//                                          +----> of a lattice of triangles, where there is room
#pragma once

#include <optional>

#include "sizing/asked_rules.hpp"
#include "surfaces/surface.hpp"

namespace surfmesh {

/// A plane, or a cylinder of a radius, over a box of its parameters.
struct EvenSurface {
    const Surface& surface;
    std::optional<double> radius;
    ParameterBox box;

    [[nodiscard]] Point2 speeds() const { return {radius.value_or(1.0), 1.0}; }  // |r_u|, |r_v|
    /// Of the box in the scaled plane.
    [[nodiscard]] Point2 extent() const;
};

struct InwardSizes {
    double largest;
    bool on_lattice;  // it is that of triangles that form one
};

/// No positive number where the rules allow none.
[[nodiscard]] InwardSizes inward_sizes(const EvenSurface& even, const AskedRules& asked);

}  // namespace surfmesh
