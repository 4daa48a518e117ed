// Bounds of a function's Taylor coefficients up to the fourth order, over a cell of (u, v).
//
//     f(u + s, v + t) = f + sum c_kl s^k t^l + ...     c_kl within rad[k, l] of mid[k, l],
//                                                      whatever (u, v) of the cell
//
// Products and compositions are those of power series whose coefficients are balls: what cancels in
// the coefficients cancels in their middles. Round-off is a part of the radii; that of the radii
// themselves, all of them positive, is a relative one, which the last step adds. A radius that is
// infinite, or not a number, says that nothing is known.
//
// Source: Moore, Kearfott, Cloud, "Introduction to Interval Analysis", SIAM 2009, chapter 9, for
// Taylor coefficients by intervals; Rump, "Fast and parallel interval arithmetic", BIT 39 (1999),
// 534-554, for middles and radii. Functions by their own coefficients.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "surfaces/interval.hpp"
#include "surfaces/tape.hpp"

namespace surfmesh::taylor {

inline constexpr std::size_t ORDER = 4, COUNT = 14;

/// By order, within it by the power of t: number (k + l)(k + l + 1)/2 + l - 1.
struct Coefficients {
    std::array<double, COUNT> mid, rad;
};

/// What a number depends on: other coefficients are 0, and need not be looked at.
enum class Variables : std::uint8_t { NONE, U, V, BOTH };

/// Of what one instruction reads: its range, and its coefficients, which lie elsewhere.
struct Operand {
    Interval range;
    const Coefficients& coefficients;
    Variables variables = Variables::BOTH;
};

/// The coefficients of what an instruction makes of up to three operands.
Coefficients of(const Instruction& step, const std::array<Operand, 3>& operands);

}  // namespace surfmesh::taylor
