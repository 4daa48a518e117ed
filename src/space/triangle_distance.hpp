// How far a point lies from a triangle in space.
//
// In: a point and three corners. Out: the distance to the nearest point of the triangle, its
// border included; of a triangle without area that to its sides.
//
//          .               over the triangle: the height above its plane
//         / \   x          elsewhere:         the distance to the nearest of its sides
//        /   \ '
#pragma once

#include "space/triangle_pairs.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// NaN where a coordinate is.
double triangle_distance(Point3 point, const Triangle3& corners);

}  // namespace surfmesh
