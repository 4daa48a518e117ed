// How long an edge may be along the direction of low curvature before that leaves the edge.
//
// Let t be the principal direction with the smaller curvature k, n the one with the larger K. By
// the equations of Codazzi the lines of curvature along t bend within the surface at the rate
// k_n / (K - k), and they fan out at the rate K_t / (K - k), where k_n is the derivative of k in
// the direction n (do Carmo, 4-3). In the frame of one point the surface has the cubic terms
//
//     k_n x^2 y / 2 + K_t x y^2 / 2,
//
// to be compared with K y^2 / 2 over a triangle of length x and width y: where they are no longer
// small beside what the larger curvature takes of the chord, a shorter triangle does with less.
#pragma once

#include <span>

#include "fields/field_nodes.hpp"
#include "surfaces/fundamental_forms.hpp"
#include "surfaces/surface.hpp"

namespace surfmesh {

/// Largest k_n x^2 y and K_t x y^2, as a share of K y^2. At the latter the width that the curvature
/// allows changes by 18% over the length, as fast as ``growth`` lets it by default: longer
/// triangles would have to be narrower, all the way to where the direction has fanned out.
inline constexpr double BENDING = 0.7, FANNING = 0.29;

/// Where rates are looked for.
struct RatePlace {
    Point2 uv;
    PrincipalDirections principal;
    bool along_first;  // is t the first principal direction?
    double size;       // a length: curvatures are compared over a small part of it
};

/// |K_t| and |k_n|, 1 / model unit^2, at some places; zero where they are not known.
SurfaceStatus direction_rates(const Surface& surface, std::span<const RatePlace> places,
                              std::span<NumberPair> rates);

/// Largest length of triangles that are ``size`` wide, at rates from above; at least that.
double longest_along(NumberPair rates, PrincipalCurvatures k, double size, double chord);

}  // namespace surfmesh
