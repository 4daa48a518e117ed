// A closer look at some triangles of a mesh: how far the farthest of many of their points lies from
// the nearest point of the surface.
//
// In: a mesh on its surfaces, some of its triangles, barycentric weights of the points. Out: the
// largest distance of each, and the place of the largest of all. Nothing changes.
#pragma once

#include <cstdint>
#include <span>

#include "quality/measured_mesh.hpp"
#include "space/measure.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// A point of a triangle, the parameters of the surface point nearest to it, how far that is.
struct FarPlace {
    std::int32_t triangle = 0;
    Point3 point = {0.0, 0.0, 0.0};
    Point2 uv = {0.0, 0.0};
    double distance = -1.0;
};

struct DenseDeviation {
    Array<double> largest;     // of each triangle that is looked at
    FarPlace farthest;         // face by face, the first of equals
    std::int32_t failed = -1;  // number of a surface, then nothing else counts
};

/// limit, steps: as for ``closest_points_in_triangles``.
DenseDeviation dense_deviation(const MeasuredMesh& mesh, std::span<const std::int32_t> triangles,
                               std::span<const Weights> weights, double limit, int steps);

}  // namespace surfmesh
