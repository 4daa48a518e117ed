// The distance of points, and of triangles, from the true surface: what the mesher aims at and
// the report measures.
//
// It is read in the tangent plane at a foot nearby, r(u, v) of the interpolated parameters, where
// that suffices, and to the nearest point of the surface where it does not:
//
//         o p              along the normal n at the foot: the distance,
//       n | `.             across: how far the foot is from the nearest point
//     ____|___`o foot
#pragma once

#include <array>
#include <span>

#include "surfaces/chart.hpp"
#include "surfaces/closest_point.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Fraction of a limit that the mesher aims at: from there a search begins anew from corners.
inline constexpr double CHORD_MARGIN = 0.96;

/// Of the triangle's size. With d near k h^2 / 8 for the distance to the tangent plane at a foot
/// that is off by s, the true distance differs by k s^2 / 2 = 4 d (s / h)^2: 1 % of d at this s / h.
inline constexpr double NEAR_FOOT = 0.05;

/// Of a projection, at most: where speeds change fast guesses are poor.
inline constexpr int PROJECTION_STEPS = 12;

using SpaceTriangle = std::array<Point3, 3>;
using PlaneTriangle = std::array<Point2, 3>;

struct PointDeviations {
    Array<double> distance;
    Array<Point3> normal;  // of the surface near the points, zero where there is none
};

/// Distances of points from the surface, and its normals near them.
///
/// uv: of a surface point nearby; size: of the triangle. Read in the tangent plane where the foot
/// is near, else in the one a Newton step further, else by projection.
PointDeviations point_deviations(SurfaceReader& surface, std::span<const Point3> points,
                                 std::span<const Point2> uv, std::span<const double> size);

/// The same of points that should be r(u, v) itself: looked at closely only if not.
Array<double> vertex_deviations(SurfaceReader& surface, std::span<const Point3> points,
                                std::span<const Point2> uv, std::span<const double> size);

/// Largest distance from the surface at samples of each triangle, with its corners on it.
///
/// xy: the corners in the plane of ``chart``, in which parameters are interpolated. Four samples
/// each, read in the tangent planes; where these come near to ``limit``, the samples of the
/// report, each with its nearest point.
Array<double> triangle_deviations(SurfaceReader& surface, const Chart& chart,
                                  std::span<const SpaceTriangle> corners,
                                  std::span<const PlaneTriangle> xy, double limit);

/// The width of the band between parallels of the surface that each triangle needs, seen from the
/// tangent planes at four samples; ``deviation`` where it lies on one side, as it was found.
Array<double> triangle_widths(SurfaceReader& surface, const Chart& chart,
                              std::span<const SpaceTriangle> corners,
                              std::span<const PlaneTriangle> xy, Array<double> deviation);

}  // namespace surfmesh
