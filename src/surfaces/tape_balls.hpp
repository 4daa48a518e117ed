// A tape run at points by middles and radii: its outputs with all round-off in their radii.
//
// In: points. Out: each output within rad of mid. Middles are computed as they are without radii, which
// grow by what half an ulp is of each of them; radii are sums of positive numbers, whose own round-off
// is a relative one, that the last step adds. Operations that have no rule here, and operands too near
// to the end of where they have one, are run by intervals (tape_bounds.hpp).
//
// Source: Rump, "Fast and parallel interval arithmetic", BIT 39 (1999), 534-554.
#pragma once

#include <span>

#include "surfaces/ball.hpp"
#include "surfaces/tape.hpp"

namespace surfmesh {

/// points: rows of the tape's inputs. Output k at point i into out[i m + k], for m outputs; the radius
/// is infinite where nothing is known.
void enclose_outputs(const Tape& tape, std::span<const double> points, std::span<Ball> out);

}  // namespace surfmesh
