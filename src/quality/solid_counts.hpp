// How many vertices and edges bound each solid, and which of its edges are open.
//
// In: triangles around solids, facing outwards; one between two solids is there twice, once each
// way. Out: counts by solid, for Euler's number. An edge is open where it is not run along as often
// one way as the other.
#pragma once

#include <cstdint>
#include <span>

#include "space/box_tree.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct SolidCounts {
    Array<std::int64_t> vertices, edges, open_edges;  // of each solid
};

/// solid: of the triangles, 0 .. solids - 1; their corners are 0 .. vertices - 1.
SolidCounts solid_counts(std::span<const TriangleCorners> triangles,
                         std::span<const std::int32_t> solid, std::size_t vertices,
                         std::size_t solids);

}  // namespace surfmesh
