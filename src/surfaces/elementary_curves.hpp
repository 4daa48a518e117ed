// Lines and conics in space and in the (u, v) plane, parametrised as CAD kernels do.
//
// In the frame (origin; x, y):
//
//     line        t d                       circle     R cos t x + R sin t y
//     ellipse     a cos t x + b sin t y     hyperbola  a cosh t x + b sinh t y
//     parabola    t^2 / (4 f) x + t y       f: the focal length
//
// Source: OCCT, package ElCLib (parametrisations).
#pragma once

#include "surfaces/curve.hpp"

namespace surfmesh {

class Line final : public Curve {
  public:
    Line(int dimension, Point3 origin, Point3 direction)
        : dimension_(dimension), origin_(origin), direction_(direction) {}

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
    int dimension_;
    Point3 origin_, direction_;
};

enum class ConicKind { ELLIPSE, HYPERBOLA, PARABOLA };  // a circle is an ellipse

/// origin + f(t) x + g(t) y
class Conic final : public Curve {
  public:
    struct Axes {
        Point3 origin, x, y;
    };
    /// major, minor: along x and y; of a parabola the focal length, and nothing.
    Conic(int dimension, ConicKind kind, const Axes& axes, double major, double minor)
        : dimension_(dimension), kind_(kind), axes_(axes), major_(major), minor_(minor) {}

    [[nodiscard]] ConicKind kind() const { return kind_; }

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
    [[nodiscard]] Point2 on_parabola(double t, int derivative) const;
    void compute_functions(std::span<const double> t, std::span<double> f,
                           std::span<double> g) const;

    int dimension_;
    ConicKind kind_;
    Axes axes_;
    double major_, minor_;
};

}  // namespace surfmesh
