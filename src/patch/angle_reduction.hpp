// Smaller sizes where neighbouring triangles meet at more than the angle asked for.
#pragma once

#include "patch/patch_state.hpp"

namespace surfmesh {

/// Lower the sizes there, split and smooth; at last split the triangles alone.
void reduce_dihedrals(PatchState& state);

}  // namespace surfmesh
