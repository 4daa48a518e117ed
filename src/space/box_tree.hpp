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
// child with child, and what lies below one node with itself.
#pragma once

#include <cstdint>
#include <span>

#include "space/triangle_pairs.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

struct TriangleCorners {
    Vertex a, b, c;
};

struct MeetingTriangles {
    std::int32_t first, second;
};

/// Pairs of triangles that meet where they should not (``triangles_meet``), the lower first, in
/// no order that means anything.
///
/// All coordinates are finite. The search ends with the two leaves where there are ``most`` pairs
/// or more.
Array<MeetingTriangles> meeting_triangles(std::span<const Point3> points,
                                          std::span<const TriangleCorners> triangles,
                                          std::size_t most);

}  // namespace surfmesh
