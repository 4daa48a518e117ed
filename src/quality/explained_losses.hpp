// How much area and volume triangles lose or win by their distance from the surface.
//
// In: triangles, their areas and distances. Out: of the area of a triangle of height h at the
// distance d about (4 d / h)^2, all of it at most; of the volume area times distance.
#pragma once

#include <span>

#include "space/box_tree.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct ExplainedLosses {
    Array<double> area, volume;  // of each triangle
};

/// area, distance: of each triangle; slant: of (d / h)^2, what the area may differ by, of its own.
ExplainedLosses explained_losses(std::span<const Point3> points,
                                 std::span<const TriangleCorners> triangles,
                                 std::span<const double> area, std::span<const double> distance,
                                 double slant);

}  // namespace surfmesh
