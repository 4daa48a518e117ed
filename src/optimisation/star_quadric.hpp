// The surface around a vertex as its neighbours show it: a quadric over its tangent plane.
#pragma once

#include "values/point.hpp"

namespace surfmesh {

/// Height of the surface over the tangent plane: (xx x^2 + 2 xy x y + yy y^2) / 2, in unit lengths
/// along the plane and model units off it.
struct Quadric {
    double xx, xy, yy;

    /// Its gradient at a place of the plane; half of that times the place is the height.
    [[nodiscard]] Point2 slope(Point2 at) const {
        return {xx * at.x + xy * at.y, xy * at.x + yy * at.y};
    }
};

/// Fits a quadric to the heights of places by least squares.
class QuadricFit {
  public:
    void add(Point2 step, double twice_the_height) {
        const double x = step.x * step.x, y = 2.0 * step.x * step.y, z = step.y * step.y;
        xx_ += x * x;
        xy_ += x * y;
        xz_ += x * z;
        yy_ += y * y;
        yz_ += y * z;
        zz_ += z * z;
        rx_ += x * twice_the_height;
        ry_ += y * twice_the_height;
        rz_ += z * twice_the_height;
    }
    /// A plane where the places determine none.
    [[nodiscard]] Quadric quadric() const {
        const double cxx = yy_ * zz_ - yz_ * yz_, cxy = xz_ * yz_ - xy_ * zz_;
        const double cxz = xy_ * yz_ - xz_ * yy_, cyy = xx_ * zz_ - xz_ * xz_;
        const double cyz = xy_ * xz_ - xx_ * yz_, czz = xx_ * yy_ - xy_ * xy_;
        const double det = xx_ * cxx + xy_ * cxy + xz_ * cxz;
        if (!(det > ON_TWO_LINES * xx_ * yy_ * zz_)) return {0.0, 0.0, 0.0};
        return {(cxx * rx_ + cxy * ry_ + cxz * rz_) / det,
                (cxy * rx_ + cyy * ry_ + cyz * rz_) / det,
                (cxz * rx_ + cyz * ry_ + czz * rz_) / det};
    }

  private:
    // Of the product of the diagonal: a smaller determinant says that the places lie on two lines.
    static constexpr double ON_TWO_LINES = 1e-6;

    // the normal equations (xx xy xz; xy yy yz; xz yz zz) (quadric) = (rx ry rz)
    double xx_ = 0.0, xy_ = 0.0, xz_ = 0.0, yy_ = 0.0, yz_ = 0.0, zz_ = 0.0;
    double rx_ = 0.0, ry_ = 0.0, rz_ = 0.0;
};

}  // namespace surfmesh
