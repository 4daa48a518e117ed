// How many places of (u, v) the vertices of a mesh have: one as a rule, two at a seam, four where two
// seams cross, and as many as there are triangles at a pole.
//
// In: the corners of the triangles as vertices and as places. Out: the number of each vertex.
#pragma once

#include <cstdint>
#include <span>

#include "space/triangle_corners.hpp"
#include "values/array.hpp"

namespace surfmesh {

Array<std::int32_t> corner_places(std::span<const TriangleCorners> triangles,
                                  std::span<const TriangleCorners> uv_triangles,
                                  std::size_t vertices, std::size_t places);

}  // namespace surfmesh
