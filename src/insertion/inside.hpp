// Section 3, step 5: what lies inside, grown from seeds on the inner side of the segments.
//
// In: a triangulation whose segments are fixed edges. Out: its triangles told apart, INSIDE and
// OUTSIDE for closed loops, or in patches between segments. Only segments stop the growth.
#pragma once

#include <cstdint>
#include <span>

#include "insertion/segment_recovery.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// Everything connected to the left side of an edge is INSIDE, the rest OUTSIDE.
[[nodiscard]] Recovery grow_inside(Triangulation& t, std::span<const HalfEdge> edge);

struct Patches {
    Array<std::int32_t> label;  // of the triangles: number of the patch, NIL for dead slots
    std::int32_t count = 0;
};

/// Number the patches between segments: a patch grows from every triangle that has none yet.
///
/// adj, fixed: of the half-edges; region: of the triangles. The patch of the ghosts is the outside
/// of everything.
Patches label_patches(std::span<const HalfEdge> adj, std::span<const std::uint8_t> fixed,
                      std::span<const Region> region);

}  // namespace surfmesh
