// Patches on one side of the plane of a flat patch beside them: the two do not meet.
//
//         | Q |  |        P lies in a plane across an axis that supports Q: nothing of Q is beyond it,
//    o----o---o--o---o    and what Q has in it, single vertices and edges, are vertices and edges of P.
//     \  / \ / \/ P /     As P does not meet itself, a triangle of P has nothing of them but corners
//      o----o---o--o      and sides that it shares with the triangle of Q.
//
// Found from edge to edge between patches, and held against all triangles of Q, exactly. A patch that
// also has something else in the plane, or is beside two flat ones in it, is left out.
//
// In: points, triangles, the half-edges beside each other, and patches that do not meet themselves
// (graph_patches.hpp). Nothing changes.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "space/graph_patches.hpp"
#include "space/triangle_corners.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// The flat patches whose planes support a patch: three across x, y, z that it is above, three that
/// it is below; NIL: none.
using SupportingPatches = std::array<std::int32_t, 6>;

/// Of each patch.
///
/// twins: of each half-edge the one that runs along the same edge the other way, or NIL.
Array<SupportingPatches> supporting_patches(std::span<const Point3> points,
                                            std::span<const TriangleCorners> triangles,
                                            std::span<const HalfEdge> twins,
                                            const GraphPatches& patches);

}  // namespace surfmesh
