// A curve at a fixed distance from another, with exact derivatives:
//
//     c + d m / |m|     m = c' x a     in the plane a is its normal, and m (c'_y, -c'_x)
//
// Where that one has no tangent, the offset is that close by.
//
// Source: OCCT, Geom_OffsetCurve, Geom2d_OffsetCurve (sides of the offset).
#pragma once

#include <memory>
#include <optional>

#include "surfaces/curve.hpp"

namespace surfmesh {

/// The part of a curve in use.
struct CurveLimits {
    double first, last;
};

class OffsetCurve final : public Curve {
  public:
    /// direction: a, for a curve in space.
    OffsetCurve(std::shared_ptr<const Curve> curve, double distance, Point3 direction,
                std::optional<CurveLimits> limits)
        : curve_(std::move(curve)), distance_(distance), direction_(direction), limits_(limits) {}

    [[nodiscard]] int dimension() const override { return curve_->dimension(); }
    void evaluate(std::span<const double> t, int order, std::span<Point3> out) const override;
    /// Where the curve bounds its derivatives to the third order, and has a tangent.
    [[nodiscard]] bool enclose_along(Interval t, Point3 w, Point3 about,
                                     CurveAlong& out) const override;

  private:
    [[nodiscard]] Point3 side() const;
    bool enclose_point(double t, Point3 w, Point3 about, Interval& out) const;
    [[nodiscard]] double beside_cusp(double t) const;

    std::shared_ptr<const Curve> curve_;
    double distance_;
    Point3 direction_;
    std::optional<CurveLimits> limits_;
};

}  // namespace surfmesh
