// Gradation of the edges of a model along edges and straight across the faces between them.
//
//          fine
//        o-o-o-o-o            An edge knows what is asked along it and at its vertices; the sizes
//           |  way            inside a face grow from all its edges. Where an edge is coarser than
//     o-----+-----o           what grows to it across the face, the face on its other side would
//         coarse              not hear of that, and sizes would jump at the edge.
//
// In: samples along edges with the sizes asked for, and the edges of each face. Out: graded sizes,
//
//     size_i = min over j of (size_j + slope * way from j to i),
//
// with ways along edges, through vertices and straight from edge to edge of one face, as sizes grow
// inside it; there sizes are linear between samples, a few for each size.
#pragma once

#include "edges/edge_gradation.hpp"

namespace surfmesh {

/// The edges of faces, each once: those of face f from first[f] to first[f + 1].
struct EdgesOfFaces {
    std::span<const std::int64_t> first, edges;
};

/// least_step: of the way between two samples of one edge. before: sizes that this has found from
/// others, none of them smaller, or none: then sizes grow from what is smaller now alone.
Array<double> graded_over_faces(const EdgeNetwork& edges, const EdgesOfFaces& faces,
                                std::span<const double> sizes, double slope, double least_step,
                                std::span<const double> before = {});

}  // namespace surfmesh
