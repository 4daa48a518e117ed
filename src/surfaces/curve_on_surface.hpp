// A curve in space that lies on a surface: c(t) = r(p(shift + rate t)) with a curve p in (u, v).
//
//     c'  = r_u u' + r_v v'
//     c'' = r_uu u'^2 + 2 r_uv u' v' + r_vv v'^2 + r_u u'' + r_v v''
//
// Bounds follow from those of p and of the surface over a box around p: its second derivatives, and
// its first by how much it changes over the box.
//
// Derivatives beyond the second are no numbers, as is all where the surface cannot be evaluated.
#pragma once

#include <memory>
#include <utility>

#include "surfaces/curve.hpp"
#include "surfaces/surface.hpp"

namespace surfmesh {

class CurveOnSurface final : public Curve {
  public:
    CurveOnSurface(std::shared_ptr<const Surface> surface, std::shared_ptr<const Curve> pcurve,
                   double shift, double rate)
        : surface_(std::move(surface)), pcurve_(std::move(pcurve)), shift_(shift), rate_(rate) {}

    [[nodiscard]] int dimension() const override { return 3; }
    void evaluate(std::span<const double> t, int order, std::span<Point3> out) const override;
    [[nodiscard]] bool derivative_magnitudes(std::span<const ParameterRange> ranges, int order,
                                             std::span<Point3> out) const override;
    [[nodiscard]] bool enclose_along(Interval t, Point3 w, Point3 about,
                                     CurveAlong& out) const override;

  private:
    std::shared_ptr<const Surface> surface_;
    std::shared_ptr<const Curve> pcurve_;
    double shift_, rate_;
};

}  // namespace surfmesh
