// All triangles use the chord about alike, and none exceeds it: for as few triangles as can be.
//
// In: an optimised patch with sizes that are the same in all directions, larger than a field without
// regard to directions has them. Vertices move until triangles lie about as far from the surface
// everywhere; where that is too far, vertices are inserted at the farthest and all around move
// again. So what is short of room takes it from what has enough. Out: what is left too far.
#pragma once

#include "patch/patch_state.hpp"

namespace surfmesh {

/// Fraction of ``chord`` that triangles shall use. Beyond, more vertices have to be inserted than
/// larger triangles save.
inline constexpr double USED_EVENLY = 0.84;

/// Is that what is asked for?
[[nodiscard]] inline bool uses_evenly(const AskedAccuracy& asked, const Background& background) {
    return asked.fewest && asked.chord && !background.is_anisotropic();
}

/// first: no earlier round has made the sizes. Instead of ``approach_surface``.
Array<Triangle> approach_evenly(PatchState& state, bool first);

}  // namespace surfmesh
