// B-spline curves, rational or not, in space or in the (u, v) plane.
//
// Source: Piegl, Tiller, "The NURBS Book", 2nd edition, 1997: A3.2 (sums over control points) and
// A4.2 (quotient rule). Sums run over the distances from a control point in the middle of the
// span, which is added in the end: derivatives keep their digits far from the origin, where they
// would else be small differences of large coordinates.
#pragma once

#include "surfaces/bezier_piece.hpp"
#include "surfaces/bezier_ranges.hpp"
#include "surfaces/curve.hpp"
#include "surfaces/spline_basis.hpp"

namespace surfmesh {

class SplineCurve final : public Curve {
  public:
    /// weights: one a control point, or none. There are degree + 1 more knots than points.
    SplineCurve(int dimension, std::span<const double> knots, std::span<const Point3> control,
                std::span<const double> weights, SplineLimits limits)
        : dimension_(dimension),
          basis_(knots, knots.size() - control.size() - 1, limits),
          control_(control),
          weights_(weights) {}

    [[nodiscard]] int dimension() const override { return dimension_; }
    void evaluate(std::span<const double> t, int order, std::span<Point3> out) const override;
    [[nodiscard]] bool derivative_magnitudes(std::span<const ParameterRange> ranges, int order,
                                             std::span<Point3> out) const override;
    [[nodiscard]] bool enclose_along(Interval t, Point3 w, Point3 about,
                                     CurveAlong& out) const override;
    [[nodiscard]] bool enclose_third(Interval t, const Directions& directions, Point3 about,
                                     CurveParts& out) const override;
    [[nodiscard]] bool enclose_tangent(double t, BoxedVector& out) const override;

  private:
    double coefficients(const SpanPart& part, Point3 about, std::span<Homogeneous> control) const;
    [[nodiscard]] CurveBoxes boxes_of_part(const SpanPart& part, const Directions& directions,
                                           Point3 about, int order, const BezierCorner* end) const;

    int dimension_;
    SplineBasis basis_;
    Array<Point3> control_;
    Array<double> weights_;
};

}  // namespace surfmesh
