// Exact orientation of four points in space, by the same means as in the plane (predicates.hpp).
//
// A floating-point filter settles almost every case; the rest goes in stages: the determinant of
// the rounded differences without error, their errors in first order, and at last a sum of 96
// terms without error (J.R. Shewchuk, Adaptive precision floating-point arithmetic, Discrete &
// Computational Geometry 18, 1997, 4.3). Where products of three coordinates may under- or
// overflow, their exponents are kept as integers (exact_sums.hpp): the sign is that of the given
// numbers for all finite ones.
#pragma once

#include "values/point.hpp"

namespace surfmesh {

/// Six times the signed volume of abcd; its sign is exact: > 0 where abc is seen from d clockwise.
///
/// For all finite coordinates; nan where one is not finite.
double orient_space(Point3 a, Point3 b, Point3 c, Point3 d);

}  // namespace surfmesh
