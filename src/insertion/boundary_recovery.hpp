// Section 3 of the paper: the boundary of a domain is inserted into a packing (Wang, Ming and Lo
// 2007), in five steps that never search the whole mesh: each starts where the last one ended.
//
//   1 the segments are given: nodes, and pairs of nodes        3 segments are recovered by swaps
//   2 nodes, and a row of vertices beside them, are inserted   4 what crowds the boundary goes
//   5 what is not inside goes, grown from the inner side of the segments
//
// In: a packing as a triangulation of the plane, which is used up; the size field; the boundary.
// Out: the triangulated domain, in which every segment is a chain of one fixed edge; or what is
// wrong with the boundary, and where.
#pragma once

#include <cstdint>
#include <span>

#include "fields/background.hpp"
#include "insertion/inside_regions.hpp"
#include "insertion/segment_recovery.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// A triangulated domain of the scaled plane.
struct DomainMesh {
    Triangulation t;
    Array<Vertex> node;      // the vertex of each boundary node, NIL where no triangle uses it
    Array<Vertex> same;      // the vertex of the node that each coincides with in space, or its own
    Array<Vertex> on_kinks;  // vertices where the surface has two normals
    Array<Point3> points;    // where the nodes lie in space; empty: on the surface
};

/// What comes of a recovery: a domain where the outcome is ``finished``.
struct RecoveredDomain {
    BoundaryOutcome outcome;
    DomainMesh domain;
};

/// Closed loops; the inside is on the left of every segment.
struct LoopBoundary {
    std::span<const Point2> nodes;
    std::span<const Segment> segments;
    std::span<const Segment> inner;          // within the domain: the surface is on both sides
    std::span<const std::int64_t> identity;  // the first node that is the same point in space
    std::span<const Point3> points;          // of the nodes in space; empty: on the surface
};

/// Insert the loops and keep their inside.
[[nodiscard]] RecoveredDomain recover(Triangulation&& packing, const Background& background,
                                      const LoopBoundary& boundary);

/// Segments of a planar domain, cut into pieces; loops of them are outer ones or holes.
struct PlanarBoundary {
    std::span<const Point2> nodes;
    std::span<const Segment> pieces;
    std::span<const std::int32_t> segment;  // that each piece is part of; each has a piece
    std::span<const LoopSegment> loop_segments;
    std::span<const std::uint8_t> is_hole;  // of the loops
};

/// Insert the segments of a planar domain and keep the regions that are inside.
[[nodiscard]] RecoveredDomain recover_regions(Triangulation&& packing, const Background& background,
                                              const PlanarBoundary& boundary);

}  // namespace surfmesh
