// Bounds of a function's Taylor coefficients up to the fourth order, over a cell of (u, v).
//
//     f(u + s, v + t) = f + sum c_kl s^k t^l + ...     |c_kl| <= size[k, l], whatever (u, v)
//
// Products and compositions are those of power series with the sizes in place of the coefficients:
// all are positive, so that round-off is a relative one, which the last step adds. A result that is
// infinite, or not a number, says that nothing is known.
//
// Source: Neher, "Geometric series bounds for the local errors of Taylor methods", in Computing
// Suppl. 15 (2001); majorants of Cauchy. Functions by their own coefficients.
#pragma once

#include <array>
#include <cstddef>

#include "surfaces/interval.hpp"
#include "surfaces/tape.hpp"

namespace surfmesh::majorants {

inline constexpr std::size_t ORDER = 4, COUNT = 14;

/// Sizes by order, within it by the power of t: number (k + l)(k + l + 1)/2 + l - 1.
using Sizes = std::array<double, COUNT>;

/// Of what one instruction reads: its range, and its sizes.
struct Majorant {
    Interval range;
    Sizes sizes;
};

/// The sizes of what an instruction makes of up to three operands.
Sizes of(const Instruction& step, const std::array<Majorant, 3>& operands);

}  // namespace surfmesh::majorants
