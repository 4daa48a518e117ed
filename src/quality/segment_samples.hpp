// Points of the curves of CAD edges between the nodes of the segments that stand for them.
//
//            x  x  x           c(t) at fractions of the way from one node to the next
//         x           x
//       o---------------o      nodes; straight edges whose nodes lie on their line are left out:
//                              there the curve is the segment
//
// In: segments (rows of two nodes) with their edges and where along these their ends are; curves by
// edge, null where there is none. Nothing changes.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "surfaces/curve.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct EdgeSegments {
    std::span<const Curve* const> curves;         // of the edges
    std::span<const ParameterRange> limits;       // of the edges: t where the fraction is 0 and 1
    std::span<const std::int32_t> edges;          // of the segments
    std::span<const std::array<double, 2>> ends;  // fractions along the edge, of the segments
    std::span<const std::array<Vertex, 2>> nodes;
    std::span<const Point3> points;  // of the nodes
};

struct SegmentSamples {
    Array<std::int32_t> segments;  // those that are looked at
    Array<Point3> points;          // of each, one a fraction
    // the larger distance of its nodes from the curve where that is an ellipse, of which they are
    // at most half a turn apart; else infinite
    Array<double> off_arc;
};

/// on_curve: of the length of a segment; those whose nodes are farther off say nothing.
SegmentSamples segment_samples(const EdgeSegments& all, std::span<const double> fractions,
                               double on_curve);

/// The same of some of the segments, by their numbers, as far as their edge is one of those known.
SegmentSamples samples_of_some(const EdgeSegments& all, std::span<const std::int32_t> some,
                               std::span<const double> fractions, double on_curve);

}  // namespace surfmesh
