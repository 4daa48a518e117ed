// A tape run over cells of (u, v) by intervals: bounds of its outputs' derivatives.
#pragma once

#include <array>
#include <span>

#include "surfaces/tape.hpp"

namespace surfmesh {

/// The largest absolute values of the derivatives of orders 2 to 4, uu ... vvvv, of output k over
/// cell i into out[i m + k], for m outputs; infinite where they are not known.
///
/// lo, hi: corners of the cells, rows of two numbers; a tape with other inputs is none here.
void high_derivatives(const Tape& tape, std::span<const double> lo, std::span<const double> hi,
                      std::span<std::array<double, 12>> out);

}  // namespace surfmesh
