// Gradation along the edges of a model: sizes grow along an edge, and from edge to edge where they
// meet, by no more than a slope times the way.
//
// In: samples along edges with the sizes asked for. Out: graded sizes,
//
//     size_i = min over all samples j of (size_j + slope * way from j to i along edges),
//
// with ways through vertices. Dijkstra's algorithm over the vertices, a sweep along each edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "triangulation/segments.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// Samples of all edges in one row, and the vertices that edges join.
struct EdgeNetwork {
    std::span<const Point3> points;
    std::span<const std::int64_t> first;  // samples of edge e: first[e] to first[e + 1]
    std::span<const SegmentEnds> ends;    // of the edges: vertices
    std::size_t vertices;                 // how many there are
};

/// Grades sizes along the edges of one network, as often as it is asked to.
class EdgeGradation {
  public:
    /// least_step: of the way between two samples.
    EdgeGradation(const EdgeNetwork& edges, double slope, double least_step);
    [[nodiscard]] Array<double> graded(std::span<const double> sizes) const;

  private:
    struct End {
        std::size_t edge;
        bool at_start;
    };
    class Spreading;

    [[nodiscard]] std::int64_t first(std::size_t e) const { return edges_.first[e]; }
    [[nodiscard]] std::int64_t last(std::size_t e) const { return edges_.first[e + 1] - 1; }
    [[nodiscard]] bool is_empty(std::size_t e) const { return last(e) < first(e); }
    void link_vertices();

    EdgeNetwork edges_;
    double slope_;
    Array<double> step_;             // from each sample to the next one
    Array<std::int64_t> first_use_;  // of the vertices: where their ends of edges begin
    std::vector<End> uses_;
};

/// The same once.
Array<double> graded_along_edges(const EdgeNetwork& edges, std::span<const double> sizes,
                                 double slope, double least_step);

}  // namespace surfmesh
