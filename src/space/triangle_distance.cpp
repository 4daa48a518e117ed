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

double triangle_distance(Point3 point, const Triangle3& corners) {
    const Point3 ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const Point3 ap = point - corners[0];
    const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
    const double pb = dot(ap, ab), pc = dot(ap, ac);
    const double det = bb * cc - bc * bc;
    const double v = (cc * pb - bc * pc) / det, w = (bb * pc - bc * pb) / det;
    if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) {  // not so where there is no area
        const Point3 offset = ap - v * ab - w * ac;
        return std::sqrt(dot(offset, offset));
    }
    const double to_ab = squared_from_side(ap, ab), to_ac = squared_from_side(ap, ac);
    const double to_bc = squared_from_side(ap - ab, ac - ab);
    return std::sqrt(std::min(std::min(to_ab, to_ac), to_bc));
}

}  // namespace surfmesh
