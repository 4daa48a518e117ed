// Does a lattice of triangles, laid along principal directions at one place, lie so everywhere?
//
// Of a packing grown from one place the edges keep their direction where the metric of its sizes is
// flat and principal directions are parallel in it: on cylinders, and on minimal surfaces that chord
// alone decides the sizes of. With e1, e2 = h d1, h d2, steps of one size along the directions, that
// is where steps commute: [e1, e2] = a e1 + b e2 = 0. On the way along an edge the lattice turns
// against them by as much as sqrt(a^2 + b^2) at most (do Carmo, Riemannian Geometry, ch. 2: the
// connection of a frame).
#pragma once

#include "sizing/size_rules.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Triangles across a surface, both ways, from which a lattice is laid: rims have rows of their own.
inline constexpr double LEAST_ROWS = 24.0, LEAST_ROWS_STRETCHED = 16.0;

/// Where sizes depend on the direction, on saddles whose metric of sizes is flat: there all directions
/// are alike but for the edges of a lattice, and the best ones are those of b = -1.
///
/// extent: of the surface's chart. rules: for such a lattice, none of them the caller's own. slope:
/// growth of sizes per length at most. The reader says whether it could be told.
[[nodiscard]] bool keeps_lattice(SurfaceReader& surface, Point2 extent, const SizeRules& rules,
                                 double slope);

}  // namespace surfmesh
