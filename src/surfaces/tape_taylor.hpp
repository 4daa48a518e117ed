// A tape run over cells of (u, v) by intervals: bounds of its outputs' derivatives.
#pragma once

#include <array>
#include <span>

#include "surfaces/tape.hpp"

namespace surfmesh {

/// Derivatives of orders 2 to 4, uu ... vvvv, each within rad of mid.
struct DerivativeBalls {
    std::array<double, 12> mid, rad;
};

/// Those of output k over cell i into out[i m + k], for m outputs; radii are infinite where they are
/// not known.
///
/// lo, hi: corners of the cells, rows of two numbers; a tape with other inputs is none here.
void high_derivatives(const Tape& tape, std::span<const double> lo, std::span<const double> hi,
                      std::span<DerivativeBalls> out);

}  // namespace surfmesh
