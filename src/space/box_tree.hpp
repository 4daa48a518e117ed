// Pairs of triangles that meet, found by a balanced binary tree of boxes.
//
// Triangles are sorted along a space-filling curve; the tree over that order is implicit, a heap:
//
//                 0                 children of node k: 2k + 1, 2k + 2
//              /     \              .
//            1         2            the leaves are the last 2^depth nodes, each holds LEAF
//           / \       / \           triangles in their order; the last leaves may be empty
//          3   4     5   6
//
// What lies below two nodes of one level is compared where their boxes have a point in common,
// child with child, and what lies below one node with itself; but not where all of it belongs to one
// patch that cannot meet itself (graph_patches.hpp).
#pragma once

#include <cstdint>
#include <span>

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
/// not meet. The search ends with the two leaves where there are ``most`` pairs or more.
Array<MeetingTriangles> meeting_triangles(std::span<const Point3> points,
                                          std::span<const TriangleCorners> triangles,
                                          std::span<const std::int32_t> patches, std::size_t most);

}  // namespace surfmesh
