// A tape run over points, a block of them at a time, whose registers stay in the cache.
#pragma once

#include <span>

#include "surfaces/tape.hpp"
#include "values/point.hpp"

namespace surfmesh {

inline constexpr std::size_t TAPE_BLOCK = 256;  // points or cells: a register of points is 2 kB

/// Outputs 3 k, 3 k + 1, 3 k + 2 at point i into out[k n + i], for n points.
///
/// points: n rows of tape.inputs() numbers. out: n values for each three outputs; outputs beyond
/// a multiple of three are left out. What is undefined comes out as nan or infinity.
void evaluate(const Tape& tape, std::span<const double> points, std::span<Point3> out);

}  // namespace surfmesh
