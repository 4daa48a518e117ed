// Pairs of triangles that meet, found by a tree of boxes with eight children a node.
//
// Triangles are sorted along a space-filling curve; the tree over that order is implicit, level by
// level:
//
//     .---------------.---     the highest level is one group of up to eight boxes
//     0       ...     7        the boxes of a group lie side by side: a box is compared with all of
//    / \             / \       them at once. Group k holds those of the groups 8 k to 8 k + 7 of the
//   0...7   ...   56...63      level below; those of the lowest, the leaves, are of triangles
//
// What lies below two groups of one level is compared where their boxes have a point in common,
// child with child, and what lies below one group with itself; but not where all of it belongs to
// one patch that cannot meet itself (graph_patches.hpp), or to two of which one supports the other
// (supporting_planes.hpp).
#pragma once

#include <cstdint>
#include <span>

#include "space/supporting_planes.hpp"
#include "space/triangle_corners.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct MeetingTriangles {
    std::int32_t first, second;
};

/// Pairs of triangles that meet where they should not (``triangles_meet``), the lower first, in
/// no order that means anything.
///
/// All coordinates are finite. patches: a number for each triangle, or NIL; those of one number do
/// not meet. support: of each patch, or nothing. The search ends where there are ``most`` pairs or a
/// few more.
Array<MeetingTriangles> meeting_triangles(std::span<const Point3> points,
                                          std::span<const TriangleCorners> triangles,
                                          std::span<const std::int32_t> patches,
                                          std::span<const SupportingPatches> support,
                                          std::size_t most);

}  // namespace surfmesh
