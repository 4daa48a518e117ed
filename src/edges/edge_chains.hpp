// Chains of edges, as the polygons of their samples, and the points of them that are closest to
// given points.
//
//     points   o       o       o      (of one side of a narrow face, say)
//              :       :       :
//     chain  --x---o---x---o---x--    feet x: first on the polygon, then on the curve itself
//
// The points run along the chain, the other way: where it is closed, this tells its end from its
// start.
#pragma once

#include <cstdint>
#include <span>

#include "edges/curve_pieces.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// Samples of the edges of a model in one row.
struct SampleRows {
    std::span<const double> t;            // fractions of the edges' ranges, rising
    std::span<const std::int64_t> first;  // samples of edge e: first[e] to first[e + 1]

    [[nodiscard]] std::size_t start(std::int64_t edge) const {
        return static_cast<std::size_t>(first[static_cast<std::size_t>(edge)]);
    }
    [[nodiscard]] std::size_t count(std::int64_t edge) const {
        return start(edge + 1) - start(edge);
    }
    /// The part of a row over all samples that is of one edge.
    template <class T>
    [[nodiscard]] std::span<T> of(std::span<T> row, std::int64_t edge) const {
        return row.subspan(start(edge), count(edge));
    }
};

/// The same with their points and the curves that they lie on.
struct SampledEdges : SampleRows {
    std::span<const Point3> points;
    const CurvePieces& curves;
};

/// One use of an edge.
struct DirectedEdge {
    std::int64_t edge;
    bool is_reversed;
};

/// Edges one after the other: n segments between n + 1 points.
struct EdgeChain {
    Array<Point3> points;
    Array<std::int64_t> place, edge;  // of the segments: which of the chain's edges, and its number
    Array<double> t, t_end;           // of the segments: where they start and end on that edge

    [[nodiscard]] std::size_t segments() const { return edge.size(); }
};

/// The chain of some edges; empty where none of them has samples. place: of the first one.
EdgeChain chain_of(const SampledEdges& edges, std::span<const DirectedEdge> which,
                   std::int64_t place = 0);

/// The closest points of a chain.
struct ChainFeet {
    Array<std::int64_t> segment;
    Array<double> t, distance;  // t: on the segment's edge
};

/// Of points to a chain with segments.
void feet_on_chain(const CurvePieces& curves, std::span<const Point3> points,
                   const EdgeChain& chain, ChainFeet& found);

/// The closest points of one edge, by Newton's method. t: guesses that are made better.
void feet_on_edge(const CurvePieces& curves, std::int64_t edge, std::span<const Point3> points,
                  std::span<double> t, std::span<double> distance);

}  // namespace surfmesh
