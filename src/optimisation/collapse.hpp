// Removal of interior vertices that are too close to others, or have too few triangles.
#pragma once

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// Remove interior vertices with an edge below ``shortest`` or with at most ``few`` triangles.
///
/// Returns how many were removed; stars must be found anew afterwards. Of neighbours only one goes
/// in a call: the half-edges of the others become stale. Vertices around those that go, or should
/// have gone and could not, become active and dirty.
int collapse_short_edges(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                         double shortest, int few);

}  // namespace surfmesh
