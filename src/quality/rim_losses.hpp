// What the rims of faces lose: their segments are chords of the curves of edges.
//
//         .--x--.        sagitta x of a segment: by the angles between it and those before and after
//       o---------o      it on the same edge, about twice that of an arc
//
// Area that a rim may lose is its length times how far its curve may lie from it, at most its
// length. Where faces meet at an angle their common edge lies farther from its chord than they do:
//
//       face  |  /        the distance of the chord from one face over the sine
//             | /  edge   of the angle, not below ``sharpest``, is that from the
//       chord o'          edge within the other
//
// In: points, triangles of faces, the edge table (space/edge_table.hpp), sagittas of some edges and
// distances of the triangles from their surfaces. Nothing changes.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "quality/joined_triangles.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// About twice the sagittas of segments, those of one edge after each other, by their angles: 0
/// where an edge is one segment.
Array<double> edge_sagittas(std::span<const Point3> points,
                            std::span<const std::array<Vertex, 2>> segments,
                            std::span<const std::int32_t> edges);

/// Sagittas of edges, by their rows: the larger where one has two; NIL stands for none.
struct Sagittas {
    std::span<const std::int64_t> rows;
    std::span<const double> values;
};

struct RimLosses {
    Array<double> of_edges;  // 0 where one is no rim
    Array<double> of_faces;  // but for edges of three triangles or more
};

/// Rims are edges of one triangle, and those with a sagitta. distance: of the triangles.
RimLosses rim_losses(const JoinedTriangles& mesh, const Sagittas& sagittas,
                     std::span<const double> distance, double sharpest);

}  // namespace surfmesh
