// The planes of triangles in space, and how long their sides are.
//
// In: points and triangles, and which of these. Out: for each the cross product of two sides over
// its length (zero where that is zero), that length, twice the area, and the longest side.
#pragma once

#include <cstdint>
#include <span>

#include "space/triangle_corners.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct TrianglePlanes {
    Array<Point3> normal;
    Array<double> twice_area, longest;
};

TrianglePlanes triangle_planes(std::span<const Point3> points,
                               std::span<const TriangleCorners> triangles,
                               std::span<const std::int32_t> chosen);

}  // namespace surfmesh
