// What the distance to other edges of a face asks of an edge.
//
//     o------o------o      triangles across are about as long as it is wide there; where it is too
//       gap              narrow for that to matter they may be longer, and slivers ask for nothing
//     o------o------o
//
// In: samples along edges, which edges faces have, and the law. Out: sizes at the samples.
#pragma once

#include "space/edge_distances.hpp"

namespace surfmesh {

/// Sizes by the distance; lengths in model units.
struct GapLaw {
    double along;            // of the distance
    double least;            // no size is smaller
    double ignored;          // a gap that is narrower asks for nothing,
    double ignored_of_size;  // nor one narrower than this part of the size there
    double longer;           // edges nearer than ``narrowest`` ask for so many times the distance,
    double narrowest;        // or for this where that
    double least_narrow;     // would be less
};

/// Infinite where nothing is asked for. asked: the sizes there without gaps.
Array<double> gap_sizes(const SampledEdges& sampled, std::span<const double> asked,
                        const GapLaw& law);

}  // namespace surfmesh
