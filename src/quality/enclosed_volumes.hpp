// The volumes that triangles enclose: sums of signed tetrahedra (divergence theorem).
//
// In: triangles around solids, facing outwards, and for each solid a point near it, which the
// tetrahedra share: to one far away the volumes would cancel in rounding. Out: one volume a solid,
// summed up without the rounding of long sums; NaN or infinite where a coordinate is.
#pragma once

#include <cstdint>
#include <span>

#include "space/box_tree.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// solid: of the triangles, rows of ``apexes``.
Array<double> enclosed_volumes(std::span<const Point3> points,
                               std::span<const TriangleCorners> triangles,
                               std::span<const std::int32_t> solid, std::span<const Point3> apexes);

}  // namespace surfmesh
