// The fewest triangles that the chord of each face allows, whatever their shape, and the fewest
// equilateral ones (sizing/least_counts.hpp).
//
// In: a mesh on its surfaces, its edges, areas and chords. The curvature is looked at in the
// middles of some of its triangles, along the lines around a face at every node. With n segments
// around it, a face of Euler number x has n - 2 x triangles, and two more for each vertex within:
// so many are needed at least, and where the surface is curved both ways what its area needs.
//
// Out: of each face the larger of both. The mesh does not change.
#pragma once

#include <cstdint>
#include <span>

#include "quality/measured_mesh.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// What is asked for. Where the chord of a face is infinite its rims count alone, as lines that are
/// straight.
struct LeastRequest {
    std::span<const double> chord;            // of each face
    std::span<const std::uint8_t> is_corner;  // of each vertex: lines end there
    bool balanced;                            // vertices may lie off the surface
};

struct LeastTriangles {
    Array<double> least, equilateral;  // of each face
    std::int32_t failed = -1;          // number of a surface, then nothing else counts
};

/// edges: both sides of each edge, or its half-edge and NIL.
LeastTriangles least_triangles(const MeasuredMesh& mesh, std::span<const EdgeSides> edges,
                               std::span<const double> area, const LeastRequest& request);

}  // namespace surfmesh
