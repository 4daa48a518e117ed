// The figures of each face in one pass over the triangles of a finished mesh.
//
// In: triangles on faces, and what is known of each triangle. Out: sums and extremes of each face,
// added up in the order of the triangles.
#pragma once

#include <cstdint>
#include <span>

#include "quality/joined_triangles.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct FaceShapes {
    Array<std::int64_t> triangles;
    Array<double> area, alpha_sum, alpha_min;  // alpha_min is infinite where there is no triangle
};

FaceShapes face_shapes(const JoinedTriangles& mesh, std::span<const double> area,
                       std::span<const double> alpha);

struct FaceDistances {
    Array<double> largest;       // NaN where one is, 0 without triangles
    Array<std::int32_t> worst;   // the first triangle where that is; 0 where there is none
    Array<double> square;        // mean square times area, summed up
    Array<std::int64_t> marked;  // how many triangles are
};

struct TriangleDistances {
    std::span<const double> distance, mean_square, area;
    std::span<const std::uint8_t> marked;  // not 0 where it counts
};

FaceDistances face_distances(const JoinedTriangles& mesh, const TriangleDistances& of);

}  // namespace surfmesh
