// Edges that run side by side are cut with nodes that face each other.
//
//     a  o-------o-------o------o      the nodes of one edge have feet on its mate, which is cut
//        :       :       :      :      there and nowhere else; where that would leave a node of its
//     b  o-------o-------o------o      own (a vertex of a third edge) the other edge gets its foot
//
// Two polygons whose nodes face each other do not cross, however near to each other their curves
// are: cut one by one they would where the distance is less than the sag of a segment.
#pragma once

#include <cstdint>
#include <span>

#include "edges/edge_gradation.hpp"
#include "edges/edge_mates.hpp"

namespace surfmesh {

/// What is known and asked of all edges, one entry each.
struct MatedEdges {
    std::span<const SegmentEnds> ends;      // vertices by the numbers that they have in the mesh
    std::span<const SegmentEnds> vertices;  // by their rows in ``corners``
    std::span<const Point3> corners;
    std::span<const double> length, total_curvature;
    std::span<const std::int64_t> fewest;  // segments
    std::span<const double> chord;     // what these may sag by; infinite where nothing is asked for
    std::span<const double> shortest;  // no longer ones are cut for it
    double diagonal;                   // of the model
    double most;                       // pieces of one edge: with more it is refused anyway
};

/// Fractions from 0 to 1 at which edges are cut.
struct MatedCuts {
    Array<std::int64_t> edge, first;  // those of edge[i] are t from first[i] to first[i + 1]
    Array<double> t;
};

/// Of all edges with a run or with one along them. sizes: at the samples, graded.
MatedCuts mated_cuts(const SampledCurves& samples, const MateRuns& runs, const MatedEdges& edges,
                     std::span<const double> sizes);

}  // namespace surfmesh
