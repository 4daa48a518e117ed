// Pairs of edges of one face that may run side by side.
//
//      \  a              a --------- a
//       \____ b          b --------- b       edges that meet and turn back; edges that do not meet
//     acute corner        near somewhere     and are somewhere no farther apart than narrow faces
//
// In: samples along edges, the edges of each face, coedges that follow each other, and how wide a
// face is narrow. Out: rows of a face and two of its edges, both ways; those that meet first, then
// by widths in the order of their first faces.
#pragma once

#include "space/edge_distances.hpp"

namespace surfmesh {

/// Two edges of a face.
struct EdgesBeside {
    std::int64_t face, own, mate;
};

/// Coedges, and which of them follow each other in their loops.
struct FollowingCoedges {
    std::span<const std::int64_t> edge, face;
    std::span<const std::uint8_t> is_reversed;
    std::span<const std::int64_t> one, other;  // that follows it
};

/// Edges that meet turn back where the cosine between their ways into the vertex and out of it is
/// above ``acute``. width: of the faces, up to where they are narrow; of those with none nothing is
/// looked at. sampled.reach is not looked at.
Array<EdgesBeside> edges_beside(const SampledEdges& sampled, const FollowingCoedges& following,
                                std::span<const double> width, double acute);

}  // namespace surfmesh
