// Do two triangles in space meet where they should not? Judged exactly.
//
// Corners at the same place are one vertex, whatever their numbers. Triangles that share
//
// - no vertex meet when they have any point in common;
// - one vertex     when they have another point in common;
// - two vertices   when they lie in one plane on the same side of their edge: a fold;
// - three          always.
//
// Most pairs of neighbours are told apart by a plane between them, found and judged in floating
// point with a margin for rounding. Only the others are looked at exactly. A triangle without
// area meets nothing: it is a fault of its own, and its neighbours hold its edges.
#pragma once

#include <array>
#include <span>

#include "space/triangle_corners.hpp"
#include "values/point.hpp"

namespace surfmesh {

using Triangle3 = std::array<Point3, 3>;

/// Do two triangles with finite corners meet where they should not?
bool triangles_meet(const Triangle3& s, const Triangle3& t);

/// Do triangles of a mesh that share one vertex surely not meet, by a plane through it that is
/// between them? False for all others; what it says is true whatever lies at one place.
bool are_parted_neighbours(std::span<const Point3> points, const TriangleCorners& s,
                           const TriangleCorners& t);

}  // namespace surfmesh
