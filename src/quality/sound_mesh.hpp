// What has to hold of every mesh, in one look: the report says in words what does not.
//
// In: the arrays of a mesh as they are held, of any numbers. Out: whether all is well.
#pragma once

#include <cstdint>
#include <span>

#include "space/triangle_corners.hpp"

namespace surfmesh {

/// Are all vertices in range and used, no corner twice in a triangle, no triangle twice?
bool are_proper(std::span<const TriangleCorners> triangles, std::size_t vertices);

/// Is none of them infinite, or no number?
bool are_finite(std::span<const double> values);

/// Are all of them from 0 to count - 1?
bool are_in_range(std::span<const std::int32_t> numbers, std::size_t count);

}  // namespace surfmesh
