// Steps 2 and 3 of section 3 in a row: a packing gets a row of vertices along the boundary, the
// boundary's nodes and its segments.
//
// In: a packing as a triangulation of the plane, the size field, nodes and segments. Out: the same
// triangulation with every node a vertex and every segment a fixed edge; or what is in the way.
#pragma once

#include <span>

#include "fields/background.hpp"
#include "insertion/segment_recovery.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// A packing with the boundary in it, where the outcome is ``finished``.
struct Insertion {
    BoundaryOutcome outcome;
    Triangulation t;
    Vertex first_node = NIL;  // vertices from this one on are nodes
    Array<Vertex> vertex;     // of the nodes
    Array<Segment> segments;  // between vertices
    Array<HalfEdge> edge;     // of the segments
};

/// One region without segments, and room for fixed edges: what insertion starts from.
void prepare_insertion(Triangulation& t);

/// with_row: a row of vertices is put to the left of each of these segments between nodes.
[[nodiscard]] Insertion insert_boundary(Triangulation&& packing, const Background& background,
                                        std::span<const Point2> nodes,
                                        std::span<const Segment> segments,
                                        std::span<const Segment> with_row);

}  // namespace surfmesh
