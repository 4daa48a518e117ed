// Triangles that lie beside each other in the (u, v) plane, in halves of halves.
//
//     +-----+--+--+        by the middle one along the longer side of all their middles, as the
//     |     |  |  |        triangles lie in space: of as many on either side, or one more
//     |     +--+--+
//     |     |     |
//     +-----+-----+
//
// In: corners in (u, v). Out: groups of the same members, whose order within a group is changed.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "proof/plane_piece.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// A triangle, and three times its middle in (u, v).
struct PlacedTriangle {
    Point2 middle;
    std::int32_t triangle;
};
using TriangleGroup = std::span<PlacedTriangle>;

Array<PlacedTriangle> placed_triangles(std::span<const PlaneCorners> uv);

/// Of a group of two or more.
std::array<TriangleGroup, 2> halves_of(TriangleGroup group, std::span<const PlaneCorners> uv);

}  // namespace surfmesh
