// Boxes around the solids of a mesh.
//
// In: points, triangles, and of each triangle the solid behind and the one before it, or NIL. Out:
// of each solid the lowest and the highest coordinates of its triangles, infinite without any.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "space/triangle_corners.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct SolidBoxes {
    Array<Point3> low, high;
};

SolidBoxes solid_boxes(std::span<const Point3> points, std::span<const TriangleCorners> triangles,
                       std::span<const std::array<std::int32_t, 2>> beside, std::size_t solids);

}  // namespace surfmesh
