// Dihedral angles across the seams of a domain: half-edges of its border that are one in space.
#pragma once

#include "optimisation/dihedral.hpp"

namespace surfmesh {

/// Pairs of half-edges that are identified, at poles too, and the angles across them.
///
/// number: for each vertex the one that it coincides with in space, or itself. Beyond a triangle
/// with two corners at a pole, which is an edge in space, lies the next one.
DihedralAngles dihedrals_across_seams(const Triangulation& t, const Array<Point3>& point,
                                      const Array<Vertex>& number);

}  // namespace surfmesh
