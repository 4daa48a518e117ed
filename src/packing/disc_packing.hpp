// One step of the front when radii are drawn at random (Wang, Ming and Lo 2007, section 2.3).
//
// A circle of the drawn radius is tried on the front edge a -> b. Where it overlaps another, the
// largest circle that touches three is tried, then the support is pushed out:
//
//               other                          the support grows from (a, b) to (a, other): the
//           P .                                circle P touches both, b is left in the polygon
//        /     `  .  other                     a, b, other, P, which is triangulated
//       a --- b --- '
#pragma once

#include "packing/packing_state.hpp"

namespace surfmesh {

inline constexpr Vertex LOOK_AHEAD = 32;  // radii among which one is sought that spans a wide gap

/// One step of the front at the edge; at least ``LOOK_AHEAD`` radii are drawn for circles to come.
///
/// Returns false when the edge has to wait. ``forced``: all edges wait, do what is valid although
/// it is not good.
bool advance_disc(Packing& p, FrontEdge edge, bool forced);

}  // namespace surfmesh
