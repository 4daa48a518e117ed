// Integrals over strips of the (u, v) plane: from a fixed u to each of many ends (u, v), at its v.
//
//     F(u, v) = integral of f(x, v) dx from the fixed u to u
//
// What areas and volumes are made of by Green's theorem (surfmesh.intersection.contents). f is the
// element of area |r_u x r_v|, or of the volume between the surface and a point o,
// (r - o) . (r_u x r_v) / 3. A rule is used between all knots in a strip, and on the halves of
// each piece; pieces in which these differ are halved. Nothing changes.
#pragma once

#include <optional>
#include <span>

#include "surfaces/surface_reader.hpp"

namespace surfmesh {

struct StripRule {
    std::span<const double> places, weights;  // of a quadrature over [0, 1]
    double agree;  // relative to the integral of |f| over a strip: results that are the same
    int halvings;  // at most; the finest pieces are taken as they are
};

/// Of each strip. knots: rising. origin: o; none for areas.
Array<double> strip_integrals(SurfaceReader& surface, double fixed, std::span<const Point2> ends,
                              std::span<const double> knots, const StripRule& rule,
                              const std::optional<Point3>& origin);

}  // namespace surfmesh
