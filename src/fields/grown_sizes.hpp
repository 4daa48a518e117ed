// The background of sizes that grow with the distance from points of known size, over a box.
//
// In: sources in a plane with a constant metric, and the box that is asked for. Out: the tree of
// source_tree.hpp over root cells that are squares in the metric, so many that each looks at few
// sources, the longer side of the box met exactly.
#pragma once

#include "fields/source_tree.hpp"

namespace surfmesh {

inline constexpr std::int64_t MOST_SOURCE_CELLS = std::int64_t{1} << 26;

/// A rectangle of the plane, with width and height.
struct PlaneBox {
    Point2 low, high;
};

/// What lies beyond the box's upper and right sides may be covered too.
[[nodiscard]] GrownTree grow_sizes(const Sources& sources, const PlaneBox& box,
                                   Fineness fineness = Fineness::for_mesh);

}  // namespace surfmesh
