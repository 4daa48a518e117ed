#include "space/triangle_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

constexpr double LEAST = std::numeric_limits<double>::min();  // instead of zero below a fraction

/// Squared distance of the end of ``way`` from the segment from 0 to ``side``.
double squared_from_side(Point3 way, Point3 side) {
    const double t = std::clamp(dot(way, side) / std::max(dot(side, side), LEAST), 0.0, 1.0);
    const Point3 offset = way - t * side;
    return dot(offset, offset);
}

}  // namespace

double DistanceToTriangle::from_sides(Point3 ap) const {
    const double to_ab = squared_from_side(ap, ab_), to_ac = squared_from_side(ap, ac_);
    const double to_bc = squared_from_side(ap - ab_, ac_ - ab_);
    return std::sqrt(std::min(std::min(to_ab, to_ac), to_bc));
}

}  // namespace surfmesh
