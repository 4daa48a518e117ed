// The metric area that a background gives to a rectangle: how many circles will cover it.
#pragma once

#include "fields/background.hpp"

namespace surfmesh {

/// Integral of det A = 1 / det H over [x0, x1] x [y0, y1], (x0, y0) the background's corner.
///
/// A is bilinear in a leaf, its determinant of degree two in x and in y: two by two points of
/// Gauss are exact, also in a leaf that the rectangle cuts.
[[nodiscard]] double metric_area_of_box(const Background& background, double x1, double y1);

struct LeafAreas {
    Array<Point2> low, step;  // lower left corners, and width and height
    Array<double> area;
};

/// Of the leaves in the same rectangle, cut off where it ends.
[[nodiscard]] LeafAreas leaf_areas(const Background& background, double x1, double y1);

enum class Axis : std::uint8_t { x, y };

/// The coordinate along the axis from ``low`` to the corner ``upper`` up to which half the metric
/// area of the box lies, by so many bisections.
[[nodiscard]] double halving_coordinate(const Background& background, Axis axis, double low,
                                        Point2 upper, int bisections);

/// About how many circles cover the rectangle: its metric area over that of a circle's share,
/// sqrt(3) / 2, and some more.
[[nodiscard]] std::size_t expected_circles(const Background& background, Point2 upper);

}  // namespace surfmesh
