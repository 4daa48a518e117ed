// A finished mesh with its edge table: what the figures of a report are of.
//
// Faces are numbered from 0 to faces_in_all - 1. Nothing here is checked; the bindings have done so,
// once for all figures.
#pragma once

#include <cstdint>
#include <span>

#include "space/edge_table.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct JoinedTriangles {
    std::span<const Point3> points;
    std::span<const TriangleCorners> triangles;
    std::span<const std::int32_t> faces;  // of the triangles
    std::size_t faces_in_all;
    std::span<const EdgeTable::Ends> edges;
    std::span<const EdgeTable::Sides> half_edges;
    std::span<const std::int32_t> uses;
};

}  // namespace surfmesh
