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
    std::array<double, 3> heights, lengths;
    double tilt;  // by how much the axes may be wrong
    double turn;  // how much faster |r - L| may change as corners are off
};

TriangleFrame frame_of(const SpaceCorners& p, double corner, RimSides rims);

using BySide = std::array<double, 3>;

/// Suprema of |d . r''(e, e)| for the three sides e, along the three axes d; along the normal, the
/// last of them, those of either sign too.
struct SideBends {
    std::array<BySide, 3> by_axis{};  // [axis][side]
    BySide up{-intervals::INFINITE, -intervals::INFINITE, -intervals::INFINITE}, down = up;
    // of d . (r''(e, e) - r''(f, f)) for the two sides other than k: [axis][k]
    std::array<BySide, 3> differ{};
};

/// The largest of l_0 l_1 a + l_1 l_2 b + l_2 l_0 c over the simplex; never less than 0.
///
/// Inside it is a b c / D with D = 2 (ab + bc + ca) - (a^2 + b^2 + c^2) where each number is less
/// than the sum of the others; else on the side of the largest, a quarter of that. A number below 0
/// is the curvature along its side, upwards: there is no largest value inside then.
double largest_on_simplex(double a, double b, double c);

/// Of both.
void take_larger(SideBends& all, const SideBends& other);

/// How high and how far a piece is at most from a triangle, point by point.
struct PieceSize {
    double height, whole;
};
PieceSize size_from(const SideBends& bends, const TriangleFrame& frame);

/// How far in all, where more is known of the height.
double whole_with(const SideBends& bends, const TriangleFrame& frame, double height);

/// From the largest |(r' - L')(e)| / |e| for the sides e to unit w: between the directions of two
/// sides at an angle A it is at most the larger part over cos(A / 2).
double slope_of(const BySide& part, const TriangleFrame& frame);

/// Infinite bounds, where nothing is known, make what they bound infinite; so does with_slope=false
/// of the slope, for which ``differ`` is asked.
TriangleBounds bounds_from(const SideBends& bends, const TriangleFrame& frame, double corner,
                           bool with_slope);

/// Of two bounds of one triangle: a height from either, all else from that whose cells are lower.
inline TriangleBounds lower_of(const TriangleBounds& a, const TriangleBounds& b) {
    TriangleBounds found = b.cell_whole < a.cell_whole ? b : a;
    found.height = std::min(a.height, b.height);
    found.whole = std::min(a.whole, b.whole);
    found.slope = std::min(a.slope, b.slope);
    return found;
}

}  // namespace surfmesh
