// How the insertion of a boundary ends, and where.
#pragma once

#include <cstdint>

#include "values/conventions.hpp"

namespace surfmesh {

enum class Recovery : std::uint8_t {
    finished,
    node_taken,          // a node lies on an earlier node or segment
    crossing,            // a segment crosses an earlier one
    segment_on_node,     // a segment runs through a node
    not_recovered,       // swaps did not end
    lost,                // a segment is no edge any more
    leak,                // the inside reaches infinity: a loop is open or runs the wrong way
    different_loops,     // a region lies in different loops by different ways
    unreachable_region,  // a region cannot be reached from the infinite one
    nothing_inside,      // the holes cover all of the domain
};

/// A segment from node to node, or from vertex to vertex.
struct Segment {
    std::int32_t start, end;
};

/// How the recovery of one segment ends, and the half-edge concerned.
struct SegmentOutcome {
    Recovery status;
    HalfEdge half_edge;
};

/// How all ends, the number of the node, segment or region reached, and the half-edge concerned.
struct BoundaryOutcome {
    Recovery status = Recovery::finished;
    std::int32_t number = NIL;
    HalfEdge half_edge = NIL;
};

}  // namespace surfmesh
