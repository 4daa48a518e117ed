// How far second derivatives along a triangle's sides are from linear.
//
// In: a piece, derivatives of r over it by middle and radius. Out: rho of each side e_k along each axis,
// a sixth of the largest R''''(e_k, e_k, e, e) for sides e; those of R = r(psi) come from the second to
// fourth of r, as psi is quadratic: with p = psi'(.) and q = psi''(., .),
//
//     R''''(a, a, b, b) = r''''(p_a, p_a, p_b, p_b) + r'''(p_a, p_a, q_bb)
//         + r'''(p_b, p_b, q_aa) + 4 r'''(p_a, p_b, q_ab) + r''(q_aa, q_bb) + 2 r''(q_ab, q_ab)
//
// These are sums of weights times derivatives; what cancels in them does so at the middles, of p over
// the piece and of the derivatives over the cell. Weights are polynomials W of p and q whose
// coefficients are positive, so within W(|p| + rad) - W(|p|) of those of the middles p.
#pragma once

#include <array>

#include "proof/side_bends.hpp"
#include "surfaces/fourth_derivatives.hpp"

namespace surfmesh {

/// rho of a triangle's sides along its axes: [axis][side].
using FourthParts = std::array<BySide, 3>;

inline constexpr BySide UNKNOWN_SIDES = {intervals::INFINITE, intervals::INFINITE,
                                         intervals::INFINITE};
inline constexpr FourthParts UNKNOWN_PARTS = {UNKNOWN_SIDES, UNKNOWN_SIDES, UNKNOWN_SIDES};

/// Derivatives over a cell by coordinate, and what is added for round-off: side by side, for the many
/// triangles that read them.
struct DerivativeRows {
    using Row = std::array<double, HIGH_DERIVATIVES>;
    std::array<Row, 3> mid, rad;
    Row rounding;

    explicit DerivativeRows(const HighDerivatives& over);
};

/// Infinite where nothing is known.
FourthParts fourth_parts(const DerivativeRows& over, const PlanePiece& piece,
                         const Directions& axes);

}  // namespace surfmesh
