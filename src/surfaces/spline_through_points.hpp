// The spline of odd degree k through points, with knots at the points but those next to its ends
// ("not a knot"): the unique smooth one, the same bits on every processor.
//
// In: places that rise, more than k of them, and so many numbers at each. Out: flat knots, clamped
// at both ends, and control points. Interpolation matrices of B-splines are totally positive, so
// that elimination needs no pivots and the matrix stays a band.
//
// Source: C. de Boor, A. Pinkus, Backward error analysis for totally positive linear systems,
// Numerische Mathematik 27, 1977.
#pragma once

#include <cstddef>
#include <span>

#include "values/array.hpp"

namespace surfmesh {

struct KnotsAndControl {
    Array<double> knots;    // (n + k + 1,)
    Array<double> control;  // (n, dimension), point by point
};

/// places (n,), values (n, dimension), n > degree.
KnotsAndControl spline_through_points(std::span<const double> places,
                                      std::span<const double> values, std::size_t dimension,
                                      std::size_t degree);

}  // namespace surfmesh
