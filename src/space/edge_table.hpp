// The edges of a mesh, each once, and the triangles beside them: connectivity by index alone.
//
// In: triangles, any numbers as vertices. Out: edges in the order of their lower, then their higher
// vertex; of each the first two half-edges along it, 3 t + k from corner k of triangle t, the lower
// first, and how many there are. A repeated corner gives a loop, an edge like any other.
#pragma once

#include <compare>
#include <cstdint>
#include <span>

#include "space/triangle_corners.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct EdgeTable {
    struct Ends {
        Vertex lower, higher;

        friend auto operator<=>(const Ends&, const Ends&) = default;
    };
    struct Sides {
        std::int32_t first, second;  // NIL: there is no second
    };
    Array<Ends> edges;
    Array<Sides> half_edges;
    Array<std::int32_t> uses;  // of each edge, by triangles
};

EdgeTable edge_table(std::span<const TriangleCorners> triangles);

/// The row of each pair of vertices, in either order, among the edges of a table; NIL: none.
Array<std::int64_t> edge_rows(std::span<const EdgeTable::Ends> edges,
                              std::span<const EdgeTable::Ends> pairs);

/// Of each half-edge the one beside it that runs the other way, or NIL.
///
/// sides: of the table of these triangles; those that do not run along one edge are left out.
Array<std::int32_t> opposite_half_edges(std::span<const TriangleCorners> triangles,
                                        std::span<const EdgeTable::Sides> sides);

}  // namespace surfmesh
