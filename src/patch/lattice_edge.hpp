// How a lattice of equilateral triangles is laid on a surface so that it deviates least.
//
// Edges along the direction of normal curvature kn sag by h^2 kn / 8. With b the ratio of the
// smaller curvature to the larger one, -1 to 1, the largest kn of the three is least where one of
// them runs along the direction of the smaller curvature, and from b = -0.6 down, where that one
// and the others would bend as much to either side, turned from it until they do again:
//
//     b = 0, a cylinder            b = -1
//           axis                     15 degrees from either direction
//            |   /
//            |  /  30 degrees
//            | /
//
// Of stretched triangles, on saddles only, the same holds in the metric of their sizes, in which b is
// -1 everywhere.
//
// In: a surface, its chart, a place. Out: the direction in the plane.
#pragma once

#include <optional>

#include "surfaces/chart.hpp"
#include "surfaces/surface.hpp"

namespace surfmesh {

/// Direction of an edge at a place of the scaled plane; none where nothing is known there, or all
/// directions are alike.
[[nodiscard]] std::optional<Point2> lattice_edge(const Surface& surface, const Chart& chart,
                                                 Point2 place, bool stretched = false);

}  // namespace surfmesh
