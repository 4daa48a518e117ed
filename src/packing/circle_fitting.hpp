// Fitting a circle to its neighbours by iteration, its size read from a field (2.3.2, 2.3.3).
//
// In: the circles to touch, and the background that gives the size at each place. Out: the circle
// and how well it touches. Nothing is changed but the count of the iterations.
#pragma once

#include "packing/circle_sizes.hpp"
#include "packing/packing_state.hpp"

namespace surfmesh {

struct FittedCircle {
    Circle circle;
    double closeness;  // beta1 beta2
};

/// The circle that touches those of a and b, right of a -> b (2.3.2).
///
/// Its size depends on where it ends up: Newton on (l(P, a), l(P, b)) = (1, 1), the size read
/// again at each step.
FittedCircle fit_to_two(const Triangulation& t, const CircleSizes& sizes, FrontEdge edge,
                        std::int64_t& steps);

struct TangentCircle {
    Circle circle;
    double r;  // metric distance from the three; the radius got is 2 r - 1 times the wanted one
               // when the others keep theirs. 0 where there is none
};

/// The circle that touches those of a, b and c (2.3.3), sought from ``start``.
///
/// Newton on l(P, a) = l(P, b) = l(P, c) = r.
TangentCircle fit_to_three(const Triangulation& t, const CircleSizes& sizes, FrontEdge edge,
                           Vertex c, Point2 start, std::int64_t& steps);

struct Relaxation {
    Vertex nearest;  // the nearest circle below ``reach`` but the supports, or NIL
    Point2 step;     // to the place that best touches all near ones; zero where all are touched
};

/// Look at the circles on the rim of the open cavity around a circle supported by a and b.
///
/// Between two circles of the front there is seldom room for exactly one more: one Gauss-Newton
/// step on the sum of (l - 1)^2 over the neighbours shares the misfit.
Relaxation relax_against_neighbours(const Triangulation& t, FrontEdge edge, const Circle& circle,
                                    double reach);

}  // namespace surfmesh
