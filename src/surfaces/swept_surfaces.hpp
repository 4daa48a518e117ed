// Surfaces that a curve sweeps: along a line, or round an axis.
//
//     extrusion     r(u, v) = c(u) + v d
//     revolution    r(u, v) = c(v) turned by the angle u about the axis
//
// With q = c - o for a point o of the axis and its direction a, q splits into the part h along
// the axis and the part p across it; turned by u it is h + cos u p + sin u (a x p).
//
// Source: OCCT, Geom_SurfaceOfLinearExtrusion, Geom_SurfaceOfRevolution (parametrisations).
#pragma once

#include <memory>

#include "surfaces/curve.hpp"
#include "surfaces/face_surface.hpp"
#include "surfaces/third_derivatives.hpp"

namespace surfmesh {

class ExtrusionSurface final : public FaceSurface, public ThirdDerivatives {
  public:
    /// The direction has unit length, so that v is a length.
    ExtrusionSurface(const ParameterBox& domain, std::shared_ptr<const Curve> curve,
                     Point3 direction)
        : FaceSurface(domain), curve_(std::move(curve)), direction_(direction) {}
    SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                           std::span<Point3> out) const override;
    SurfaceStatus derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                        std::span<Point3> out) const override;
    SurfaceStatus enclose(std::span<const Point2> uv, std::span<EnclosedPoint> out) const override;
    SurfaceStatus enclose_bends(std::span<const ParameterBox> cells,
                                std::span<const Directions> directions,
                                std::span<Bends> out) const override;
    [[nodiscard]] bool enclose_third(const ParameterBox& cell, const Directions& directions,
                                     PartBoxes& out) const override;
    [[nodiscard]] bool enclose_tangents(Point2 uv, TangentBoxes& out) const override;

  private:
    std::shared_ptr<const Curve> curve_;
    Point3 direction_;
};

class RevolutionSurface final : public FaceSurface, public ThirdDerivatives {
  public:
    /// The axis has unit length; u is counter-clockwise seen against it.
    RevolutionSurface(const ParameterBox& domain, std::shared_ptr<const Curve> curve, Point3 origin,
                      Point3 axis)
        : FaceSurface(domain), curve_(std::move(curve)), origin_(origin), axis_(axis) {}
    SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                           std::span<Point3> out) const override;
    SurfaceStatus derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                        std::span<Point3> out) const override;
    SurfaceStatus enclose(std::span<const Point2> uv, std::span<EnclosedPoint> out) const override;
    SurfaceStatus enclose_bends(std::span<const ParameterBox> cells,
                                std::span<const Directions> directions,
                                std::span<Bends> out) const override;
    [[nodiscard]] bool enclose_third(const ParameterBox& cell, const Directions& directions,
                                     PartBoxes& out) const override;
    [[nodiscard]] bool enclose_tangents(Point2 uv, TangentBoxes& out) const override;

  private:
    struct CurveRoundings {
        std::array<double, 3> order;
        double jump;
    };
    struct BendsAlong {
        Interval uu, uv, vv;
        double jump_v;
    };
    bool enclose_along(Interval u, Interval v, Point3 d, const CurveRoundings& off,
                       BendsAlong& out) const;

    std::shared_ptr<const Curve> curve_;
    Point3 origin_, axis_;
};

}  // namespace surfmesh
