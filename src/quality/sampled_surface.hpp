// Points of the surfaces over the triangles of a mesh, at barycentric places of their parameters,
// and how far each is from its own triangle.
//
// In: a mesh on its surfaces, triangles and a rule for each: one of some barycentric weights. Out:
// parameters, points and distances; a surface that fails is named.
#pragma once

#include <cstdint>
#include <span>

#include "quality/measured_mesh.hpp"
#include "space/measure.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct SampledSurface {
    Array<Point2> uv;
    Array<Point3> points;
    Array<double> distance;
    std::int32_t failed = -1;  // number of a surface, then nothing else counts
};

struct SurfaceDistances {
    Array<double> distance;    // of w points over triangle t from w t on
    std::int32_t failed = -1;  // number of a surface, then nothing else counts
};

SampledSurface sampled_surface(const MeasuredMesh& mesh, std::span<const std::int32_t> triangle,
                               std::span<const std::int32_t> rule,
                               std::span<const Weights> weights);

/// The distances alone, of points at the same weights over every triangle.
SurfaceDistances surface_distances(const MeasuredMesh& mesh,
                                   std::span<const std::int32_t> triangles,
                                   std::span<const Weights> weights);

}  // namespace surfmesh
