// Pairs of triangles that meet, found by a balanced binary tree of boxes.
//
// Triangles are sorted along a space-filling curve; the tree over that order is implicit, a heap:
//
//                 0                 children of node k: 2k + 1, 2k + 2
//              /     \              .
//            1         2            the leaves are the last 2^depth nodes, each holds LEAF
//           / \       / \           triangles in their order; the last leaves may be empty
//          3   4     5   6
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

/// Place of each triangle's centroid along the Z-order curve through a box.
///
/// low: corner of the box of the points; scale: 2^20 over its longest side, a little less. All
/// coordinates are finite.
Array<std::int64_t> curve_places(std::span<const Point3> points,
                                 std::span<const TriangleCorners> triangles, Point3 low,
                                 double scale);

struct MeetingTriangles {
    std::int32_t first, second;
};

/// Pairs of triangles that meet where they should not (``triangles_meet``), the lower first.
///
/// Each leaf is compared with itself and those after it. The search ends after the leaf with which
/// there are ``most`` pairs or more.
Array<MeetingTriangles> meeting_triangles(std::span<const Triangle3> triangles, std::size_t most);

}  // namespace surfmesh
