// Exact orientation of three points: the one judge of every topological decision.
//
// A floating-point filter settles almost every case; what it cannot settle is computed in stages,
// with error-free additions and only as exactly as its sign needs (J.R. Shewchuk, Adaptive precision
// floating-point arithmetic and fast robust geometric predicates, Discrete & Computational Geometry
// 18, 1997, 4.3). Where products of coordinates may under- or overflow, their exponents are kept as
// integers (exact_sums.hpp): the sign is that of the given numbers for all finite ones.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/point.hpp"
#include "values/rounded_number.hpp"

namespace surfmesh {

inline constexpr double EPSILON = 0x1p-53;
inline constexpr double UNDERFLOW_BOUND = 0x1p-900;  // far above what underflow can take away
inline constexpr double RESULT_BOUND =
    (3.0 + 8.0 * EPSILON) * EPSILON;  // Shewchuk's resulterrbound

/// What ``orient`` falls back on where the filter does not decide.
double orient_without_filter(Point2 a, Point2 b, Point2 c);

/// Twice the signed area of abc; its sign is exact: > 0 for counter-clockwise.
///
/// For all finite coordinates; where the area is no double, the nearest one that is not zero.
inline double orient(Point2 a, Point2 b, Point2 c) {
    constexpr double FILTER = (3.0 + 16.0 * EPSILON) * EPSILON;  // Shewchuk's ccwerrboundA
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double det = left - right;
    if (std::abs(det) > FILTER * (std::abs(left) + std::abs(right)) + UNDERFLOW_BOUND) return det;
    // zero factors, not underflow: common on sides parallel to an axis
    if (left == 0.0 && right == 0.0 && (a.x == c.x || b.y == c.y) && (a.y == c.y || b.x == c.x))
        return 0.0;
    return orient_without_filter(a, b, c);
}

/// Exact orientation of three vertices.
inline double orient(const Array<Point2>& xy, Vertex a, Vertex b, Vertex c) {
    return orient(xy[a], xy[b], xy[c]);
}

/// The first of the triangles, three vertices each, that is not counter-clockwise, or -1.
std::int64_t first_not_ccw(std::span<const Point2> xy, std::span<const std::int64_t> triangles);

}  // namespace surfmesh
