// From second derivatives along a triangle's sides to what is bounded over the triangle.
//
// In: a triangle's corners; suprema of d . r''(e, e) for its sides e and three directions d. Out: its
// axes, and its TriangleBounds. Nothing is changed.
#pragma once

#include <algorithm>
#include <array>

#include "proof/triangle_bounds.hpp"
#include "surfaces/interval.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// A triangle's own axes: along its first side, across it within its plane, and its normal.
struct TriangleFrame {
    Directions axes;
    std::array<Point2, 3> sides;  // directions of the sides in the first two axes, unit
    std::array<double, 3> heights;
    double tilt;  // by how much the axes may be wrong
};

TriangleFrame frame_of(const SpaceCorners& p, double corner, RimSides rims);

using BySide = std::array<double, 3>;

/// Suprema of |d . r''(e, e)| for the three sides e, along the three axes d; along the normal, the
/// last of them, those of either sign too.
struct SideBends {
    std::array<BySide, 3> by_axis{};  // [axis][side]
    BySide up{-intervals::INFINITE, -intervals::INFINITE, -intervals::INFINITE}, down = up;
};

/// How high and how far a piece is at most from a triangle.
struct PieceSize {
    double height, whole;
};
PieceSize size_from(const SideBends& bends, const TriangleFrame& frame);

/// Infinite bounds, where nothing is known, make what they bound infinite.
TriangleBounds bounds_from(const SideBends& bends, const TriangleFrame& frame, double corner);

/// Of two bounds of one triangle: a height from either, all else from that whose cells are lower.
inline TriangleBounds lower_of(const TriangleBounds& a, const TriangleBounds& b) {
    TriangleBounds found = b.cell_whole < a.cell_whole ? b : a;
    found.height = std::min(a.height, b.height);
    return found;
}

}  // namespace surfmesh
