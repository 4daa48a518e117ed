// How far the surface's curve over a side runs from it: along the side, and across.
//
// f(s) is r over the straight side of (u, v), brought to the ends of the side in space, at the part s
// of its length l. Its derivative is 1 along the side and 0 across on the average, so that it is off
// by no more than half of l times the largest f'':
//
//     |d . (f' - e)|  <=  sup |d . r''(w, w)| / (2 l)  +  jumps at creases      w: the side in (u, v)
//
// In: sides. Out: that along e, and of two directions across it. Nothing is changed.
#pragma once

#include <array>
#include <span>

#include "surfaces/surface.hpp"

namespace surfmesh {

struct SideRate {
    double along, across;  // infinite where the surface has no bounds
};

SurfaceStatus side_rates(const Surface& surface, std::span<const std::array<Point3, 2>> ends,
                         std::span<const std::array<Point2, 2>> uv, std::span<SideRate> out);

}  // namespace surfmesh
