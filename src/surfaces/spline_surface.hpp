// B-spline surfaces, rational or not; Bezier ones have one span.
//
// Source: Piegl, Tiller, "The NURBS Book", 2nd edition, 1997: A3.6 (sums over control points) and
// A4.4 (quotient rule). Sums run over the distances from a control point in the middle of the
// span, as those of curves do.
#pragma once

#include "surfaces/bezier_piece.hpp"
#include "surfaces/bezier_ranges.hpp"
#include "surfaces/face_surface.hpp"
#include "surfaces/spline_basis.hpp"
#include "surfaces/third_derivatives.hpp"

namespace surfmesh {

class SplineSurface final : public FaceSurface, public ThirdDerivatives {
  public:
    /// control: rows of v, one for each control point along u. weights: one a control point, or
    /// none. At a crease that is a side of the domain, the derivatives are those inside.
    SplineSurface(const ParameterBox& domain, const SplineBasis& u, const SplineBasis& v,
                  std::size_t columns, std::span<const Point3> control,
                  std::span<const double> weights)
        : FaceSurface(domain),
          u_(u),
          v_(v),
          columns_(static_cast<std::int64_t>(columns)),
          control_(control),
          weights_(weights) {}

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

    [[nodiscard]] const SplineBasis& u() const { return u_; }
    [[nodiscard]] const SplineBasis& v() const { return v_; }
    [[nodiscard]] bool is_rational() const { return !weights_.empty(); }
    /// The control points that count in two spans, rows of v.
    [[nodiscard]] Array<Point3> control_of(std::int64_t u_span, std::int64_t v_span) const;

  private:
    template <int order, bool rational>
    void evaluate_as(std::span<const Point2> uv, std::span<Point3> out) const;
    template <int order, bool rational, class Number>
    auto sums_at(std::int64_t corner, const FunctionsOfSpline<Number>& by_u,
                 const FunctionsOfSpline<Number>& by_v) const;

    /// The first control point that counts in two spans, and the one in the middle of those.
    [[nodiscard]] std::int64_t corner_at(std::int64_t u_span, std::int64_t v_span) const {
        return (u_span - static_cast<std::int64_t>(u_.degree())) * columns_ + v_span -
               static_cast<std::int64_t>(v_.degree());
    }
    [[nodiscard]] std::int64_t middle_from(std::int64_t corner) const {
        return corner + static_cast<std::int64_t>(u_.degree()) / 2 * columns_ +
               static_cast<std::int64_t>(v_.degree()) / 2;
    }

    struct Work;
    struct ThirdWork;
    struct PartOfCell {
        const SpanPart &u, &v;
    };

    Bends bends_of_parts(const Directions& directions, Work& work) const;
    Bends bends_of_part(const SpanPart& u, const SpanPart& v, const Directions& directions,
                        Work& work) const;
    std::array<double, 3> jumps_between(const PartOfCell& before, const PartOfCell& after,
                                        bool along_u, const Directions& directions,
                                        Work& work) const;
    [[nodiscard]] Point3 middle_of(const PartOfCell& part) const;
    [[nodiscard]] std::int64_t corner_of(const PartOfCell& part) const;
    double controls_of(const PartOfCell& part, Point3 about, Array<Homogeneous>& control) const;
    double coefficients(const PartOfCell& part, Point3 about, Array<Homogeneous>& control) const;

    [[nodiscard]] DerivativeBoxes boxes_of_part(const PartOfCell& part,
                                                const Directions& directions,
                                                ThirdWork& work) const;
    [[nodiscard]] TangentBoxes tangents_at(const PartOfCell& part, const BezierCorner& corner,
                                           Array<Homogeneous>& control) const;

    SplineBasis u_, v_;
    std::int64_t columns_;
    Array<Point3> control_;
    Array<double> weights_;
};

}  // namespace surfmesh
