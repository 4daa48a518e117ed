// A tape run over cells of its inputs by interval arithmetic: bounds of its outputs.
#pragma once

#include <span>

#include "surfaces/interval.hpp"
#include "surfaces/tape.hpp"

namespace surfmesh {

/// What second derivatives are across kinks: infinite, or left out (those of the smooth pieces).
enum class Kinks { UNBOUNDED, LEFT_OUT };

/// Bounds of output k >= first over cell i into lower, upper[i (m - first) + k - first], for m
/// outputs. Every value of the function in the cell lies between them, wherever it is defined;
/// infinite where nothing is known.
///
/// lo, hi: corners of the cells, rows of tape.inputs() numbers.
void bounds(const Tape& tape, std::span<const double> lo, std::span<const double> hi, Kinks kinks,
            std::size_t first, std::span<double> lower, std::span<double> upper);

/// The same from output ``first`` on with round-off in them, so that they are proved: every
/// operation is rounded outwards, and constants are taken within four ulps, whole numbers exactly.
///
/// A place where the formula breaks off that lies within 1e-12 of a cell's side, of its distance
/// from zero there, counts as that side.
void enclosures(const Tape& tape, std::span<const double> lo, std::span<const double> hi,
                std::size_t first, std::span<double> lower, std::span<double> upper);

/// One instruction over n cells, its result rounded outwards; a constant as it is taken there.
void run_outward(const Instruction& step, const TapeSlots<Interval>& slots, std::size_t n);
Interval outward_constant(double x);

}  // namespace surfmesh
