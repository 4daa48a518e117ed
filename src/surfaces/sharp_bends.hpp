// Where a surface itself turns over: at a cusp, a crease, a swallowtail, a tube of no width.
//
// There r_u x r_v vanishes or changes its sense, and any triangles about it are turned against
// the normals at one of their corners, however small they are.
//
//     n  n  n              Between two samples whose normals differ most the search goes on by
//     |  |  |   _ n        halves, until the turn is spread out, or the radius it is made with,
//     o--o--o--o _         |pq| / angle, is known to be less than the one that is asked about.
//              p`o-- n
#pragma once

#include <span>

#include "surfaces/closest_point.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Does the surface bend with less than ``radius`` (model units) within each of the triangles?
///
/// Bends are found where the curvature of a sample shows them, or where the normals of two
/// samples differ.
Array<std::uint8_t> bends_sharply(SurfaceReader& surface,
                                  std::span<const ParameterTriangle> triangles, double radius);

}  // namespace surfmesh
