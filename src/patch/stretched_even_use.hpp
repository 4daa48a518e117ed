// Stretched triangles share what they may deviate by as evenly as can be: so they may be large.
//
//     all above a part of ``chord``:  swaps and moves by turns, until deviations are alike
//     those still farther than it:    the farthest are split, swaps and moves around them
//     all once more:                  what was taken on trust is measured
//
// In: a smooth mesh, whose sizes leave little of ``chord`` unused. Smoothing for unit edges makes
// triangles alike on the average only. Here corners move, and edges are swapped, while that lowers
// what the triangles around exceed a deviation by that most of them come to have. Sizes stay as
// they are. Out: as surface_approach.hpp has it.
#pragma once

#include "patch/patch_state.hpp"

namespace surfmesh {

/// Bring triangles that are farther than ``chord`` from the surface nearer, in a stretched mesh that
/// is to have as few as keep it; returns those left. first: no earlier round has made the sizes.
Array<Triangle> even_out_deviations(PatchState& state, bool first);

}  // namespace surfmesh
