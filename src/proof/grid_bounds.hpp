// Bounds of triangles by a grid of points, where the corners alone say too little.
//
//        o         Second derivatives are linear between the points of a cell but for rho / n^2
//      o   o       (smooth_bounds.hpp). The piece over the n^2 cells is no higher than the points,
//    o   o   o     and what a cell may rise over the triangle through its corners, 1 / n^2 of what
//                  the whole may over its own.
//
// In: triangles, their rho, their bounds so far. Out: lower bounds, where the points show that. A
// triangle that a point shows to be beyond its limit is given up, unless the point may lie over
// another.
#pragma once

#include <span>

#include "proof/smooth_bounds.hpp"

namespace surfmesh {

/// Of ``which`` triangles, with n = 2 and then 4 for those that are not within their limit; those
/// are left in it that lower bounds could bring there.
SurfaceStatus lower_by_grid(const FourthDerivatives& surface, const ProofRequest& asked,
                            std::span<const FourthParts> parts, Array<std::int32_t>& which,
                            std::span<TriangleBounds> out);

/// The same with points alone and n = 4 and 8, of surfaces without fourth derivatives: heights only.
SurfaceStatus lower_heights(const Surface& surface, const ProofRequest& asked,
                            Array<std::int32_t>& which, std::span<TriangleBounds> out);

}  // namespace surfmesh
