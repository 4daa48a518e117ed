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
// At a place x that is looked at, what g is not linear adds 1/2 sum_m mean_k(s_m) |d . r''''(e_k, e_k, e_m, e_m)|
// to the integral for side k at most, with s_m = l_a l_b for the ends a, b of side m, and its mean
//
//     mean_k(s_m)(x) = int int s_m(x + s ((1 - t) u_i + t u_j - x)) s ds dt
//                    = (l_a l_b + l_a [b] / 2 + l_b [a] / 2) / 12 + [k = m] / 24
//
// where [c] is 1 for an end c of side k, else 0: a 48th of the largest r'''' at the middle of a triangle, where
// rho / 6 is a 36th. Between places R - L rises by no more than the suprema of g over the triangle allow.
//
// Along the normal r'''' is within a radius of a middle, M_km for sides k and m. Such a constant adds just
// 1/2 sum_m mean_k(s_m) M_km, with its sign: the radius alone is left open. Where no places are looked at, twice
// the integral is a quadratic function of x, between its Bernstein coefficients (cell_bounds.cpp).
//
// Corners are computed once, fourth derivatives over cells that many triangles share: those are
// multiplied by the fourth power of their size. Where what is left open is so large that a grid of points
// (grid_bounds.hpp), which leaves a 16th or 256th of it, would not do, cells are cut.
//
// In: triangles. Out: their bounds, and fourth derivatives; infinite where there are none. Nothing is changed.
#pragma once

#include <span>

#include "proof/fourth_parts.hpp"
#include "surfaces/fourth_derivatives.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Bounds into ``out``, what is known of fourth derivatives into ``parts``: over cells so small that |r - L|
/// is within its limit, or what they leave open of it, where that helps.
SurfaceStatus smooth_bounds(const FourthDerivatives& surface, const ParameterBox& domain,
                            const ProofRequest& asked, std::span<TriangleBounds> out,
                            std::span<FourthParts> parts);

}  // namespace surfmesh
