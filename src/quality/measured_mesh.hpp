// A finished mesh whose surfaces and corner parameters are known: what distances are measured of.
//
// Triangles are rows of vertex numbers, and beside them rows of numbers of (u, v): at a seam one
// vertex has two. Nothing here is checked; the bindings have done so.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "space/box_tree.hpp"
#include "surfaces/surface.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct MeasuredMesh {
    std::span<const Surface* const> surfaces;  // one a face
    std::span<const Point3> points;
    std::span<const TriangleCorners> triangles;
    std::span<const Point2> uv;
    std::span<const TriangleCorners> uv_triangles;
    std::span<const std::int32_t> faces;  // of the triangles
};

/// A half-edge that is looked at, and the one beside it that shares what is found, or NIL.
struct EdgeSides {
    std::int32_t half_edge, twin;
};

}  // namespace surfmesh
