// Every edge of a model cut to pieces of equal metric length near 1.
//
//     samples with sizes       metric length along the edge       nodes at equal steps of it
//     o--o--o--o--o       ->   0 .. m, sum of 2 |dx| / (h + h')   ->   o------o------o
//
// A few pieces may be half as long again as wanted, and between samples an edge may bend more: it
// is cut into more of them while one sags by more than is allowed.
//
// In: samples of the edges (edge_gradation.hpp), the fewest pieces of each, and for some edges the
// nodes themselves. Out: nodes of all edges in one row, ends included. Ends lie on the vertices.
#pragma once

#include <cstdint>
#include <span>

#include "edges/curve_pieces.hpp"
#include "edges/edge_gradation.hpp"

namespace surfmesh {

/// What is asked of the edges in ``which``, row by row.
struct CutRequests {
    std::span<const std::int64_t> which;        // edges with samples, rising
    std::span<const std::int64_t> fewest;       // pieces
    std::span<const std::int64_t> first_given;  // where their given nodes begin, if they have any
    std::span<const double> given;              // fractions, from 0 to 1
    std::span<const double> chord;  // what a piece may sag by; infinite where nothing is asked for
    std::span<const double> shortest;  // chords of pieces that are not cut for their sag
    double most;                       // pieces of one edge
};

struct CutEdges {
    Array<std::int64_t> first;  // nodes of row k: first[k] to first[k + 1]
    Array<double> t, sizes;     // of the nodes; t: fractions of the edges' ranges
    Array<Point3> points;
    std::int64_t refused = -1;  // the row of an edge with too many pieces; nothing is cut then
    double pieces = 0.0;        // that it would have
};

/// fraction, sizes: of the samples; corners: of the vertices.
CutEdges cut_to_metric_length(const CurvePieces& curves, const EdgeNetwork& edges,
                              std::span<const double> fraction, std::span<const double> sizes,
                              std::span<const Point3> corners, const CutRequests& asked);

}  // namespace surfmesh
