// Lengths of the edges of a finished mesh, against the target sizes and against each other, in one
// pass over the edges.
//
// In: triangles with their edge table, target sizes at the vertices, or metrics at corners where
// sizes depend on the direction. Out: lengths in space and in target sizes, how they are spread, by
// face, from edge to edge. Nothing changes.
#pragma once

#include <cstdint>
#include <span>

#include "quality/joined_triangles.hpp"
#include "quality/spread.hpp"
#include "values/array.hpp"
#include "values/size_tensor.hpp"

namespace surfmesh {

/// None where all are empty.
struct TargetSizes {
    std::span<const double> at_vertices;
    std::span<const MetricRoot3> roots;  // empty where sizes do not depend on the direction
    std::span<const TriangleCorners> root_triangles;  // rows of these for the corners of triangles
};

/// What sizes may differ by from one end of an edge to the other, over its length; 0: not asked.
struct GrowthLimit {
    double slope;
    double most;  // times that: edges beyond are counted
};

/// Edges longest over shortest at a vertex; NaN where no vertex has any of a length.
struct LengthRatios {
    double largest, p99;
};

/// Along which edge sizes change most, over what is allowed, and along how many by more than most.
struct SizeChanges {
    std::int64_t steepest;  // the first of these edges; NIL where none has a length
    double largest;         // a quotient that is not finite is no change
    std::int64_t above;
};

struct EdgeFigures {
    Array<double> lengths;         // of each edge
    Array<double> metric_lengths;  // in target sizes; empty without these
    Spread length, metric_length;
    LengthRatios ratios;  // of those in the metric where sizes depend on the direction
    SizeChanges changes;
    Array<double> face_lengths, face_sizes;  // means over the edges of each face, 0 without any; an
                                             // edge between two faces counts for both
};

EdgeFigures edge_figures(const JoinedTriangles& mesh, const TargetSizes& sizes,
                         const GrowthLimit& growth);

}  // namespace surfmesh
