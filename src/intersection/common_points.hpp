// Points pulled onto two surfaces, or onto a curve and a surface, by Newton's method.
//
//     r_A(u, v) - r_B(s, t) = 0      three equations for four unknowns: the shortest step in
//                                    space; or a fourth one, a plane that the point lies in
//     c(f) - r(u, v) = 0             three for three
//
// Guesses come in and places go out, point by point; a point that has not come together has a
// gap, which is no number where a surface is not finite. Nothing else changes.
#pragma once

#include <array>
#include <span>

#include "surfaces/curve.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

inline constexpr int NEWTON_STEPS = 12;  // at most: from a good guess four are enough

/// The two surfaces that meet, each asked block after block.
struct MeetingSurfaces {
    SurfaceReader a, b;

    [[nodiscard]] bool failed() const { return a.failed() || b.failed(); }
};

/// Places on both surfaces, the points amid both, and the gaps between both.
struct CommonPoints {
    Array<Point2> uv_a, uv_b;
    Array<Point3> point;
    Array<double> gap;
};

/// u, v of the one and s, t of the other: widths of them, or rates.
using FourNumbers = std::array<double, 4>;

/// What each point is to obey beside lying on both; nothing where empty.
struct PullLimits {
    std::span<const Point3> normal, through;  // it lies in the plane through these
    std::span<const FourNumbers> widths;      // that count as equally long steps; else in space
};

/// Points on both surfaces near guesses.
CommonPoints pull_onto_both(MeetingSurfaces& surfaces, std::span<const Point2> uv_a,
                            std::span<const Point2> uv_b, const PullLimits& limits,
                            int steps = NEWTON_STEPS);

/// A piece of a curve, by fractions of its range.
struct CurvePiece {
    const Curve& curve;
    double first, last;
};

/// Where a curve meets a surface.
struct Piercings {
    Array<double> fraction;  // within 0 to 1
    Array<Point2> uv;
    Array<Point3> point;  // of the curve
    Array<double> gap;
};

/// Where a curve meets a surface, near guesses.
Piercings pull_onto_curve(const CurvePiece& piece, SurfaceReader& surface,
                          std::span<const double> fraction, std::span<const Point2> uv);

/// The box that steps in (u, v) stay in: a little wider than the domain.
ParameterBox step_limits(const ParameterBox& domain);

}  // namespace surfmesh
