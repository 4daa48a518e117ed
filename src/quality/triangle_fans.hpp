// Fans of triangles at the vertices of a mesh, and edges that both triangles run along the same way.
//
// Corners of two triangles at one vertex belong to one fan where the triangles share an edge there:
//
//      o---o---o        one fan at v: the mesh is manifold there; two that only touch: v is pinched
//       \ / \ /
//        v---o
//
// In: triangles and pairs of half-edges along one edge. Out: counts. By index alone.
#pragma once

#include <cstdint>
#include <span>

#include "space/edge_table.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Fans at each vertex. sides: pairs of half-edges that join their triangles, whichever way these
/// run along the edge; NIL: none.
Array<std::int64_t> triangle_fans(std::span<const TriangleCorners> triangles, std::size_t vertices,
                                  std::span<const EdgeTable::Sides> sides);

/// Numbers of the edges of two triangles whose half-edges start at the same end.
Array<std::int32_t> clashing_edges(std::span<const TriangleCorners> triangles,
                                   std::span<const EdgeTable::Sides> sides,
                                   std::span<const std::int32_t> uses);

/// The first vertex that belongs to no triangle, or NIL.
Vertex unused_vertex(std::span<const TriangleCorners> triangles, std::size_t vertices);

/// Have two triangles the same three corners, in any order?
bool has_repeated_triangles(std::span<const TriangleCorners> triangles, std::size_t vertices);

}  // namespace surfmesh
