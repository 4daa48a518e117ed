// The triangles of a patch, once it is optimised, as they are handed out.
#pragma once

#include "patch/patch_state.hpp"
#include "patch/seam_identification.hpp"

namespace surfmesh {

struct MappedPatch {
    Array<Point2> uv;  // of the vertices of the domain
    SurfaceTriangles seamless;
    Array<Point3> points;  // in space
    Array<double> sizes;   // of the points: of the field, with what the optimiser has made smaller
};

/// Map a patch to space and identify its seams. No pass of the optimiser may come after it.
///
/// node_uv: of the boundary's nodes that have a vertex, to the last bit. boundary: which of them
/// are one point in space; empty where none are.
MappedPatch map_to_space(PatchState& state, std::span<const Point2> node_uv,
                         const IdentifiedBoundary& boundary);

}  // namespace surfmesh
