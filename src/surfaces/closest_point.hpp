// The closest point of a surface, near a guess: how far is a mesh from what it stands for?
//
// Gauss-Newton on |r(u, v) - p|^2: (J^T J) step = J^T (p - r) with J = (r_u, r_v). For a point at
// distance d from a surface of curvature k each step divides the error by about 1 / (d k), so
// two steps do for a mesh. Source: Nocedal, Wright, "Numerical Optimization", 2006, section 10.3.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "surfaces/surface_reader.hpp"

namespace surfmesh {

inline constexpr double PROJECTION_MARGIN = 0.01;  // of the domain: seams are no walls

struct ClosestPoints {
    Array<Point2> uv;
    Array<double> distance;
    Array<Point3> foot;
};

/// Nearest points of a surface to points, from guesses, never farther than these.
///
/// margin: fraction of the domain by which they may leave it. The search is local: a nearer part
/// of the surface that the guess does not lead to is not found.
ClosestPoints closest_points(SurfaceReader& surface, std::span<const Point3> points,
                             std::span<const Point2> guesses, int steps,
                             double margin = PROJECTION_MARGIN);

/// The same, but a search that comes to a side which is joined to the opposite one goes on from
/// there; ``uv`` may lie on the other side then.
ClosestPoints closest_points_across_sides(SurfaceReader& surface, std::span<const Point3> points,
                                          std::span<const Point2> guesses, int steps);

using ParameterTriangle = std::array<Point2, 3>;

/// The same for points in triangles, where those farther than ``limit`` are searched for anew
/// from the corners of theirs, ``corners[triangle[i]]``, and across joined sides: about a singular
/// point the search from the middle finds others, and parameters change fast. ``foot`` is not kept
/// up.
ClosestPoints closest_points_in_triangles(SurfaceReader& surface, std::span<const Point3> points,
                                          std::span<const Point2> guesses,
                                          std::span<const ParameterTriangle> corners,
                                          std::span<const std::int64_t> triangle, double limit,
                                          int steps);

}  // namespace surfmesh
