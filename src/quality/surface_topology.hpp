// What kind of surface the triangles of a finished mesh form: counts from connectivity alone.
//
// In: triangles with their edge table, and which half-edges of edges of three triangles or more are
// joined. Out: counts, and the numbers of edges and vertices that are not as on a surface. No
// coordinate is looked at.
#pragma once

#include <cstdint>
#include <span>

#include "quality/joined_triangles.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct SurfaceTopology {
    std::int64_t vertices = 0;        // of a triangle
    std::int64_t components = 0;      // pieces that share no vertex
    std::int64_t boundary_edges = 0;  // of one triangle
    Array<std::int64_t> fans;         // of triangles at each vertex, as shared edges join them
    Array<std::int32_t> pinched;      // vertices of two fans or more
    Array<std::int32_t> crowded;      // edges of three triangles or more
    Array<std::int32_t> clashing;     // edges that both triangles run along the same way
};

/// chains: half-edges of crowded edges, each with the next.
SurfaceTopology surface_topology(const JoinedTriangles& mesh,
                                 std::span<const EdgeTable::Sides> chains);

}  // namespace surfmesh
