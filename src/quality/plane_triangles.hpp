// Triangles that lie in the planes of their faces: there is nothing between their corners.
//
//        p o        r(u, v) = o + u x + v y: at the same barycentric weights a point of the triangle
//        . |  `.    and the point of the surface are nowhere farther apart than at the corners, so
//    r   x---x---x  that the distances both ways are no more than that either
//
// In: a mesh on its surfaces. Out: which triangles lie in a plane to rounding. The mesh does not
// change.
#pragma once

#include <cstdint>

#include "quality/measured_mesh.hpp"
#include "surfaces/elementary_surfaces.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// The frame of a surface that is a plane, or null.
const Frame* plane_of(const Surface& surface);

/// 1 for each triangle of a plane whose three corners are r(u, v) to a billionth of its size.
Array<std::uint8_t> plane_triangles(const MeasuredMesh& mesh);

}  // namespace surfmesh
