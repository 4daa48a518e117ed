// Section 3, step 1: which nodes of a boundary are one, and the segments between them.
//
// In: nodes in (u, v) with their numbers in space, loop after loop. Out: the nodes that are kept,
// and segments between them. Edges inside a face are walked there and back, loops may touch in a
// vertex: nodes of one number at one place are one node. Images of a vertex that edges meet with
// some tolerance are one place too, if nearer to each other than a small part of the segments
// there: loops would cross in between.
#pragma once

#include <cstdint>
#include <span>

#include "insertion/outcome.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// Images of one node nearer than this fraction of the boundary's box are one node in (u, v).
inline constexpr double SAME_PLACE = 1e-6;

/// Or nearer than this fraction of the segments there.
inline constexpr double NEAR_STEP = 0.1;

struct CoincidentNodes {
    Array<std::int32_t> nodes;  // that are kept, rising: each the first of those that are one
    Array<std::int32_t> row;    // of all nodes: where theirs is among ``nodes``
};

/// numbers: of the nodes in space. segments: between nodes.
CoincidentNodes coincident_nodes(std::span<const Point2> uv, std::span<const std::int64_t> numbers,
                                 std::span<const Segment> segments);

struct LoopNodes {
    Array<std::int32_t> nodes;     // that are kept
    Array<Segment> segments;       // between these, those from a node to itself left out
    Array<std::int64_t> identity;  // of these: the first that is the same point in space
    bool runs_twice = false;       // does a segment run twice the same way?
};

/// Closed loops, one after the other; lengths: how many nodes each has.
LoopNodes loop_nodes(std::span<const Point2> uv, std::span<const std::int64_t> numbers,
                     std::span<const std::int32_t> lengths);

}  // namespace surfmesh
