// Bounds of triangles where the surface is smooth, by what it does at their corners.
//
// Of a bent piece r is r(psi) here (plane_piece.hpp). With f = d . r, x in the triangle and g_ij = d . r''(e_ij, e_ij), r - L is exactly
//
//     d . (L - r)(x) = sum_{i<j} l_i l_j  int int g_ij(x + s ((1 - t) u_i + t u_j - x)) s ds dt
//
// (triangle_bounds.hpp has the bound of that). Let g be linear between its corner values but for
// rho: then the integral is 1/2 g at the middle of the weight s, (x + u_i + u_j) / 3, so that it
// lies between the values at
//
//            u_k              (2 u_i + u_j)/3,  (u_i + 2 u_j)/3,  (u_i + u_j + u_k)/3
//           /   \             .
//          /  o  \            and rho <= 1/6 max over sides e of sup |d . r''''(e_ij, e_ij, e, e)|,
//        u_i-o-o-u_j          the same lemma for g.
//
// Corners are computed once, fourth derivatives over cells that many triangles share: those are
// multiplied by the fourth power of their size. Where rho is so large that a grid of points
// (grid_bounds.hpp), which leaves a 16th or 256th of it, would not do, cells are cut.
//
// In: triangles. Out: their bounds, and rho; infinite where there are none. Nothing is changed.
#pragma once

#include <span>

#include "proof/fourth_parts.hpp"
#include "surfaces/fourth_derivatives.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Bounds into ``out``, rho into ``rho``: over cells so small that |r - L| is within its limit, or what rho
/// is of it, where that helps.
SurfaceStatus smooth_bounds(const FourthDerivatives& surface, const ParameterBox& domain,
                            const ProofRequest& asked, std::span<TriangleBounds> out,
                            std::span<FourthParts> rho);

}  // namespace surfmesh
