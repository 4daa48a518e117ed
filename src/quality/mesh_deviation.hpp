// How far a whole mesh lies from its surfaces, and how its triangles are turned.
//
// In: the mesh, both half-edges of every edge, the areas. Looked at are the vertices, once
// each, the middles of the edges, between two faces once for either, and the centroids:
//
//              x               the seven points of a rule that integrates cubics over a triangle
//             / \              exactly. Weights: vertices 1/20, middles 2/15, centroid 9/20
//            x   x
//           /  x  \            Source: Zienkiewicz & Taylor, The Finite Element Method
//          x - x - x
//
// Out: by triangle the largest distance and the mean square. The mesh does not change.
#pragma once

#include <cstdint>
#include <span>

#include "quality/measured_mesh.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct MeshDeviation {
    Array<double> largest;      // of each triangle, at its seven points
    Array<double> mean_square;  // over each triangle
    Array<float> cosine;        // between its normal and the surface's; 1 where either is missing
    std::int32_t failed = -1;   // number of a surface that has failed, then nothing else counts
};

/// edges: each one once. in_plane: 1 for triangles of ``plane_triangles``, whose corners say all.
MeshDeviation mesh_deviation(const MeasuredMesh& mesh, std::span<const EdgeSides> edges,
                             std::span<const double> area, std::span<const std::uint8_t> in_plane);

}  // namespace surfmesh
