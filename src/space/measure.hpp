// Measures of a finished mesh: shapes of triangles, distances to a surface, connected parts.
#pragma once

#include <cstdint>
#include <span>

#include "space/box_tree.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// One value a triangle. 1 is best for alpha and the radius ratio, 0 is a triangle without area.
struct TriangleShapes {
    Array<double> area;
    Array<double> alpha;                       // 4 sqrt(3) area / sum of squared edges
    Array<double> radius_ratio;                // 2 r_in / r_circum
    Array<double> least_angle, largest_angle;  // degrees
};

/// Shape of every triangle, measured in space.
TriangleShapes triangle_shapes(std::span<const Point3> points,
                               std::span<const TriangleCorners> triangles);

/// Barycentric weights of a place in a triangle.
struct Weights {
    double a, b, c;
};

/// Values at places in triangles: rows of ``dimension`` numbers, at weights[rule[i]] of triangle[i].
Array<double> interpolate(std::span<const double> corner_values, std::size_t dimension,
                          std::span<const TriangleCorners> triangles,
                          std::span<const std::int32_t> triangle,
                          std::span<const std::int32_t> rule, std::span<const Weights> weights);

/// A point of a surface with its two derivatives.
struct TangentPlane {
    Point3 foot, ru, rv;
};

/// Where a point lies relative to a tangent plane with its foot near it.
struct TangentPlaneOffset {
    Point3 normal;  // unit normal along r_u x r_v; zero where there is none
    double along;   // distance along it; the whole distance where there is none
    double across;  // distance within the tangent plane
    Point2 step;    // in (u, v), that covers the latter (Gauss-Newton)
};

TangentPlaneOffset tangent_plane_offset(Point3 point, const TangentPlane& plane);

/// Two things that belong together.
struct ThingPair {
    std::int32_t first, second;
};

/// Label things 0 .. count - 1 by connected component: the smallest member of each.
Array<std::int32_t> component_labels(std::size_t count, std::span<const ThingPair> pairs);

}  // namespace surfmesh
