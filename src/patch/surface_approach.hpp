// Triangles that are too far from the surface are brought nearer.
#pragma once

#include "patch/patch_state.hpp"

namespace surfmesh {

/// Bring triangles that are farther than ``chord`` from the surface nearer; returns those left.
///
/// An estimate from the tangent planes picks the suspects, samples on the true surface decide;
/// afterwards only triangles that have changed are looked at again (see tracked_deviations.hpp). first: no earlier round has
/// made the sizes.
Array<Triangle> approach_surface(PatchState& state, bool first);

}  // namespace surfmesh
