// How far a point lies from a triangle in space.
//
// In: a point and three corners. Out: the distance to the nearest point of the triangle, its
// border included; of a triangle without area that to its sides.
//
//          .               over the triangle: the height above its plane
//         / \   x          elsewhere:         the distance to the nearest of its sides
//        /   \ '
#pragma once

#include <cmath>

#include "space/triangle_pairs.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// The distances of points from one triangle.
class DistanceToTriangle {
  public:
    explicit DistanceToTriangle(const Triangle3& corners)
        : a_(corners[0]),
          ab_(corners[1] - a_),
          ac_(corners[2] - a_),
          bb_(dot(ab_, ab_)),
          bc_(dot(ab_, ac_)),
          cc_(dot(ac_, ac_)),
          by_(1.0 / (bb_ * cc_ - bc_ * bc_)) {}

    /// NaN where a coordinate is.
    [[nodiscard]] double of(Point3 point) const {
        const Point3 ap = point - a_;
        const double pb = dot(ap, ab_), pc = dot(ap, ac_);
        const double v = (cc_ * pb - bc_ * pc) * by_, w = (bb_ * pc - bc_ * pb) * by_;
        if (!(v >= 0.0 && w >= 0.0 && v + w <= 1.0))  // so where there is no area
            return from_sides(ap);
        const Point3 offset = ap - v * ab_ - w * ac_;
        return std::sqrt(dot(offset, offset));
    }

  private:
    /// Of a point at ``ap`` from the first corner.
    [[nodiscard]] double from_sides(Point3 ap) const;

    Point3 a_, ab_, ac_;
    double bb_, bc_, cc_, by_;
};

/// NaN where a coordinate is.
inline double triangle_distance(Point3 point, const Triangle3& corners) {
    return DistanceToTriangle(corners).of(point);
}

}  // namespace surfmesh
