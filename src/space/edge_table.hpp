// The edges of a mesh, each once, and the triangles beside them: connectivity by index alone.
//
// In: triangles, any numbers as vertices. Out: edges in the order of their lower, then their higher
// vertex; of each the first two half-edges along it, 3 t + k from corner k of triangle t, the lower
// first, and how many there are. A repeated corner gives a loop, an edge like any other.
#pragma once

#include <cstdint>
#include <span>

#include "space/box_tree.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct EdgeTable {
    struct Ends {
        Vertex lower, higher;
    };
    struct Sides {
        std::int32_t first, second;  // NIL: there is no second
    };
    Array<Ends> edges;
    Array<Sides> half_edges;
    Array<std::int32_t> uses;  // of each edge, by triangles
};

EdgeTable edge_table(std::span<const TriangleCorners> triangles);

}  // namespace surfmesh
