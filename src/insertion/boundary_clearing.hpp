// Section 3, step 4: the quality along the boundary.
//
// In: a triangulation of the plane with fixed segments, their half-edges up to date. Out: the same
// without the vertices that crowd the boundary, and with edges swapped where triangles were bad.
// Boundary nodes and fixed edges stay; each slot of triangles is DEAD or counter-clockwise.
#pragma once

#include <cstdint>
#include <span>

#include "insertion/segment_recovery.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// Metric distance from the boundary below which an interior vertex is removed.
inline constexpr double CROWDED = 0.5;

/// Remove interior vertices that are too near to a segment between vertices, or to its ends.
///
/// ``edge``: the half-edges of the segments; each is up to date once its segment has had its turn,
/// and those of segments near by may be stale after. Vertices from ``first_node`` on are nodes and
/// stay. Gives the number of those removed, or the segment lost.
struct Cleared {
    BoundaryOutcome outcome;
    std::int64_t removed = 0;
};
[[nodiscard]] Cleared clear_boundary(Triangulation& t, std::span<const Segment> segments,
                                     Array<HalfEdge>& edge, Vertex first_node);

/// Swap edges of bad triangles INSIDE, in the metric, while that betters them. Returns how many.
std::int64_t swap_bad(Triangulation& t);

}  // namespace surfmesh
