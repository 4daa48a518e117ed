// The coedges of all faces of a model, as boundaries of faces are made of them: constant, whatever
// its edges are cut into.
//
//     nodes of the edges of the model  ->  of each coedge of a face, as its loop is walked  ->
//     in (u, v) by its p-curve         ->  FaceBoundary
#pragma once

#include <vector>

#include "edges/curve_pieces.hpp"
#include "faces/boundary_builder.hpp"

namespace surfmesh {

/// The nodes of all edges in one row, in the direction of the edges.
struct CutEdgeRows {
    std::span<const std::int64_t> first;  // of the edges and behind the last; none of one point
    std::span<const double> t;            // normalised parameters
    std::span<const std::int64_t> numbers;
    std::span<const Point3> points;
    std::span<const double> sizes;
};

struct CoedgeTable {
    CurvePieces pcurves;  // of the coedges
    Array<std::int64_t> edge;
    Array<std::uint8_t> is_reversed;
    Array<std::int64_t> first_of_loop, first_loop_of_face;  // coedges of loops, loops of faces
    Array<double> tolerance;                                // of the edges
    Array<std::int64_t> start;                              // of the edges: vertex of the mesh
    Array<Point3> corners;                                  // of these vertices

    [[nodiscard]] std::int64_t first_coedge(std::int64_t face) const {
        return first_of_loop[first_loop_of_face[face]];
    }
    [[nodiscard]] std::size_t coedges_of(std::int64_t face) const {
        return static_cast<std::size_t>(first_coedge(face + 1) - first_coedge(face));
    }
    [[nodiscard]] std::size_t faces() const { return first_loop_of_face.size() - 1; }
    [[nodiscard]] std::size_t edges() const { return start.size(); }
};

/// Of some faces, in their order.
[[nodiscard]] std::vector<FaceBoundary> boundaries_of(const CoedgeTable& table,
                                                      std::span<const std::int64_t> faces,
                                                      const CutEdgeRows& nodes);

}  // namespace surfmesh
