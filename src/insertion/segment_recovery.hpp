// Section 3, step 3: segments become fixed edges, by tracing neighbours and swaps.
//
// In: a triangulation of the plane whose vertices from ``first_node`` on are boundary nodes, and
// segments, pairs of them. Out: half-edges of the segments, or what is in the way and where. The
// elements that a segment cuts are found from neighbour to neighbour and its edge is recovered by
// swaps; vertices of the packing that lie exactly on it are removed. No step searches the whole
// mesh: each starts where the last one ended.
#pragma once

#include <span>

#include "insertion/outcome.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// Make a -> b an edge; ``start`` leaves a. Gives the half-edge a -> b or the one concerned: it
/// starts at the node met, or is the fixed edge crossed.
[[nodiscard]] SegmentOutcome recover_segment(Triangulation& t, HalfEdge start, Segment ab,
                                             Vertex first_node);

/// Recover and fix all segments between vertices, nearest to each other in a row at best.
[[nodiscard]] BoundaryOutcome recover_segments(Triangulation& t, HalfEdge near,
                                               std::span<const Segment> segments,
                                               Vertex first_node);

/// The half-edge a -> b: e if it still is, otherwise sought from ``near``; or NIL.
HalfEdge find_edge(const Triangulation& t, HalfEdge e, HalfEdge near, Segment ab);

/// Bring the segments' half-edges up to date after swaps and removals near by.
[[nodiscard]] BoundaryOutcome find_segments(const Triangulation& t,
                                            std::span<const Segment> segments,
                                            Array<HalfEdge>& edge);

}  // namespace surfmesh
