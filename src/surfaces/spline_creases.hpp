// How much a spline surface's derivative across a crease jumps there, at most.
//
//      before |  after      r is continuous at u = k, a knot as often as the degree, and r_u is
//      .--o---o---o--.      p (c_1 - c_0) / width there, from either side: with homogeneous
//         p-1 p,0 1         coefficients (A, w) the jump of r_u is (dA - dw r) / w
//
// which is (dA w - dw A) / w^2, a polynomial over a weight: by the product of Bernstein polynomials,
// so that it vanishes to rounding where the surface only looks creased by its knots.
//
// In: coefficients of the parts on both sides. Out: suprema along directions. Nothing is changed.
//
// Source: Piegl, Tiller, "The NURBS Book", 1997, 5.3; R. Farouki, V. Rajan, "Algorithms for
// polynomials in Bernstein form", Computer Aided Geometric Design 5 (1988), 1-26 (the product).
#pragma once

#include <array>
#include <span>

#include "surfaces/bezier_piece.hpp"
#include "surfaces/enclosure.hpp"

namespace surfmesh {

/// One side of a crease: coefficients about a common point, their steps across it and along it.
struct CreaseSide {
    std::span<const Homogeneous> coefficients;
    double width;
};

/// What both sides have in common.
struct CreaseShape {
    std::size_t degree, stride;       // across the crease
    std::size_t count, stride_along;  // of the coefficients along it
    bool rational;
    double error;  // of each coefficient
};

/// Suprema of the jump along directions; infinite where nothing is known.
std::array<double, 3> crease_jumps(const CreaseSide& before, const CreaseSide& after,
                                   const CreaseShape& shape, const Directions& directions);

}  // namespace surfmesh
