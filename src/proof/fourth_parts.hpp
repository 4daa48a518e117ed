// How far second derivatives along a triangle's sides are from linear.
//
// In: a piece, derivatives of r over it by middle and radius. Out: R''''(e_k, e_k, e_m, e_m) along the
// normal, by middle and radius; rho of each side e_k along each axis, a sixth of the largest
// R''''(e_k, e_k, e, e) for sides e. Those of R = r(psi) come from the second to fourth of r, as psi is
// quadratic: with p = psi'(.) and q = psi''(., .),
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

/// Of pairs of sides k <= m, in the order 00, 01, 02, 11, 12, 22.
inline constexpr std::size_t SIDE_PAIRS = 6;
inline constexpr std::array<std::size_t, SIDE_PAIRS> PAIR_FIRST = {0, 0, 0, 1, 1, 2},
                                                     PAIR_OTHER = {0, 1, 2, 1, 2, 2};
inline constexpr std::array<std::array<std::size_t, 3>, 3> PAIR_OF = {
    {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
using ByPair = std::array<double, SIDE_PAIRS>;

/// What is known of fourth derivatives over a triangle.
struct FourthParts {
    std::array<BySide, 3> rho;  // along its axes: [axis][side]
    ByPair mid, rad;            // R''''(e_k, e_k, e_m, e_m) along its normal, with all round-off
};

inline constexpr BySide UNKNOWN_SIDES = {intervals::INFINITE, intervals::INFINITE,
                                         intervals::INFINITE};
inline constexpr FourthParts UNKNOWN_PARTS = {
    .rho = {UNKNOWN_SIDES, UNKNOWN_SIDES, UNKNOWN_SIDES},
    .mid = {},
    .rad = {intervals::INFINITE, intervals::INFINITE, intervals::INFINITE, intervals::INFINITE,
            intervals::INFINITE, intervals::INFINITE}};

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
