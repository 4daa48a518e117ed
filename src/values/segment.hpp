// Distances of points from segments, in the plane and in space.
#pragma once

#include <algorithm>

#include "values/point.hpp"

namespace surfmesh {

/// From the segment between a and b, which may be one point.
template <class Point>
double distance_to_segment(Point x, Point a, Point b) {
    const Point along = b - a;
    const double length = dot(along, along);
    const double t = length > 0.0 ? std::clamp(dot(x - a, along) / length, 0.0, 1.0) : 0.0;
    return norm(x - a - t * along);
}

}  // namespace surfmesh
