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
struct SampledCurves : SampleRows {
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
    Array<Point3> way;                // of the segments, from end to end
    Array<double> square;             // of their lengths

    [[nodiscard]] std::size_t segments() const { return edge.size(); }
};

/// The chain of some edges; empty where none of them has samples.
EdgeChain chain_of(const SampledCurves& edges, std::span<const DirectedEdge> which);

/// Segments of a chain that follow each other, from ``first`` to before ``last``.
struct ChainPart {
    const EdgeChain& chain;
    std::size_t first, last;

    [[nodiscard]] std::size_t segments() const { return last - first; }
    [[nodiscard]] std::span<const Point3> points() const {
        return {chain.points.data() + first, segments() + 1};
    }
};

/// The closest points of a chain.
struct ChainFeet {
    Array<std::int64_t> segment;  // of the whole chain
    Array<double> t, distance;    // t: on the segment's edge
};

/// Finds the closest points of a part of a chain, which has segments.
class FootFinder {
  public:
    FootFinder(const CurvePieces& curves, const ChainPart& part);

    void feet(std::span<const Point3> points, ChainFeet& found);
    /// How far a point is from its foot. about: where on the part, 0 to 1, that is to be.
    double distance(Point3 p, double about);

  private:
    struct Place {
        std::int64_t segment;
        double t;
    };
    Place on_polygon(Point3 p, double about);

    const CurvePieces& curves_;
    ChainPart part_;
    Array<double> ratio_, near_;
    double longest_;
};

/// Where point i of so many that run along a chain the other way is to have its foot, 0 to 1.
inline double place_along(std::size_t i, std::size_t count) {
    if (count == 1) return 1.0;
    if (i + 1 == count) return 0.0;
    return static_cast<double>(i) * (-1.0 / static_cast<double>(count - 1)) + 1.0;
}

/// The closest points of one edge, by Newton's method. t: guesses that are made better.
void feet_on_edge(const CurvePieces& curves, std::int64_t edge, std::span<const Point3> points,
                  std::span<double> t, std::span<double> distance);

}  // namespace surfmesh
