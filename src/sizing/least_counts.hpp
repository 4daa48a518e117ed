// The fewest triangles that a chord allows, whatever their shape and size, and the fewest
// equilateral ones.
//
// For a small chord eps, over a piece of area dA with principal curvatures k1 and k2 (K = k1 k2):
//
//                  vertices on the surface    off it        source
//   least  K > 0   2 / (3 sqrt 3)             1 / (3 sqrt 3)    Fejes Toth; Gruber
//          K < 0   1 / (2 sqrt 5)             sqrt 3 / 8    Atariah, Rote, Wintraecken, 1511.01361
//          K = 0   0: rims decide
//
// times sqrt |K| / eps dA. A curve of curvature k needs the integral of sqrt(k / (8 eps)) ds
// segments, with nodes off it sqrt(k / (16 eps)), and a face at least as many triangles as the
// segments around it and its Euler number say. Nothing smaller than 2 eps is ever needed.
//
// In: curvatures at places, nodes along a line. Out: triangles on a unit of area, segments.
#pragma once

#include <span>

#include "surfaces/fundamental_forms.hpp"

namespace surfmesh {

/// Triangles on a unit of area.
struct LeastDensity {
    double least;        // any triangles
    double equilateral;  // vertices on the surface, in no special direction
};

LeastDensity least_density(PrincipalCurvatures k, double chord, bool balanced);

/// c with triangles = c |k1| / eps on a unit of area, of equilateral triangles of one size in all
/// directions alike; ratio: of the smaller curvature to the larger, -1 to 1.
double equilateral_factor(double ratio);

/// Segments that a line needs by the circles through three of its nodes each: at least 1, of a
/// closed one (whose first node is not repeated) 3.
double least_segments(std::span<const Point3> line, bool closed, double chord, bool balanced);

}  // namespace surfmesh
