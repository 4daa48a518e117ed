// From which faces the edges of a finished mesh are looked at.
//
// In: the half-edges of the edge table (space/edge_table.hpp), the faces of the triangles. Nothing
// changes.
#pragma once

#include <cstdint>
#include <span>

#include "quality/measured_mesh.hpp"
#include "space/edge_table.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Half-edges for ``mesh_deviation``: each edge within a face once; between two faces from the
/// first of them, and after all others from the second.
Array<EdgeSides> edges_of_faces(std::span<const EdgeTable::Sides> half_edges,
                                std::span<const std::int32_t> faces);

}  // namespace surfmesh
