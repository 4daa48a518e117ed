// The edge length that a curvature allows.
//
// A triangle with its corners on the quadric z = (k1 x^2 + k2 y^2) / 2 misses it by the linear
// interpolation error of z. For an equilateral triangle of side h this error is
//
// - at the centroid        h^2 |k1 + k2| / 12     (the same for every orientation),
// - at an edge's middle    h^2 |kn| / 8           (kn the normal curvature along the edge),
//
// and nowhere larger than the larger of the two, with kn at most max |k1|, |k2|, up to 4.2%
// in between (tests compare it with a dense search). On a sphere that is h^2 k / 6.
#pragma once

#include "surfaces/fundamental_forms.hpp"

namespace surfmesh {

/// Fraction of ``chord`` that a unit triangle may use: where the surface is curved one way only, and
/// where both ways alike. Deviation grows with the square of the circumradius; the few triangles
/// that are too large are brought nearer one by one. Curved one way, all triangles may have an edge
/// that runs that way; else few lie worst.
inline constexpr double DEVIATION_RESERVE = 0.74, ALIKE_RESERVE = 0.78;

/// Fraction of ``angle`` that two unit triangles may be bent by: on a sphere, where all edges are
/// alike and some triangles are larger; and for what depends on the direction, as few edges lie
/// worst.
inline constexpr double ROUND_RESERVE = 0.78, BENT_RESERVE = 0.94;

/// The same for anisotropic sizes, where triangles that lie too far are split: where the surface is
/// curved both ways, and where one way only. There edges alone decide, and few of those that run
/// that way are more than 1.15 times as long as wanted.
inline constexpr double STRETCHED_RESERVE = 0.7, STRAIGHT_RESERVE = 0.75;

constexpr double radians(double degrees) { return degrees * (3.141592653589793 / 180.0); }

/// The smaller of two numbers, and not a number where either is none: as numpy has it.
constexpr double least(double a, double b) { return a <= b || a != a ? a : b; }
/// The larger one, likewise.
constexpr double most(double a, double b) { return a >= b || a != a ? a : b; }

/// c with deviation = c h^2, for principal curvatures in 1 / model unit.
double deviation_factor(PrincipalCurvatures k);

/// Between the two by the ratio of the curvatures, whatever their signs.
double deviation_reserve(PrincipalCurvatures k);

/// Edge length at which triangles stay within ``chord`` of the surface.
///
/// Never less than 2 ``chord``: a smaller triangle is within ``chord`` whatever the curvature.
double chord_size(PrincipalCurvatures k, double chord);

/// The same where triangles form a lattice laid as ``lattice_edge`` (src/patch) has it: they use
/// 0.6 to 0.7 of the chord, and only those along rims, whose rows lie as these do, come near to it.
double lattice_chord_size(PrincipalCurvatures k, double chord);

/// c with deviation = c k^3 h^4 of quadratic triangles whose nodes lie on the surface, where k, the
/// larger curvature, and b, the signed ratio of both, do not change.
///
/// Of equilateral triangles .0020 up to b = .2 (cylinders: an arc alone has 1/512) and .0003 + .0082
/// b beyond (tori at their equators, spheres), times 1.75 for the longest edges of a mesh.
double quartic_factor(PrincipalCurvatures k);

/// Edge length at which quadratic triangles stay within ``chord`` of a surface whose curvature does
/// not change; never less than 2 ``chord``.
double quadratic_chord_size(PrincipalCurvatures k, double chord);

/// Fraction of a chord that the rules below may use where that is the width of the band around the
/// surface that a triangle needs: all of it where the surface bends one way.
///
/// On a saddle an equilateral triangle lies on both sides, its edges by h^2 kn / 8. The normal
/// curvatures along its three edges differ by sqrt(3) |k1 - k2| / 2 at most, in directions 120
/// degrees apart. For two sizes with a ``ratio`` it is the same in their metric.
double share_of_width(PrincipalCurvatures k, double ratio = 1.0);

/// Edge length at which dihedral angles are at most ``angle`` (degrees), with a reserve.
///
/// Across an edge along t, with n at right angles to it, the slope of linear interpolation of
/// a quadric jumps by h (3 k_nn - k_tt) / (2 sqrt(3)): the far corners rise by k_nn, the edge
/// itself sags by k_tt. The largest value over all directions of the edge is
/// h (|k1 + k2| / 2 + |k1 - k2|) / sqrt(3).
double angle_size(PrincipalCurvatures k, double angle);

/// Edge length at which the normals of neighbours differ by at most ``angle`` (degrees).
///
/// The normal of the surface, that is: a rule against folds, no bound on the triangles. The
/// centres of two neighbouring equilateral triangles of side h are h / sqrt(3) apart.
double normal_deviation_size(PrincipalCurvatures k, double angle);

/// Edge lengths along the directions of k1 and k2.
struct PrincipalSizes {
    double first, second;
};

/// At which triangles stay within ``chord``, for a ``ratio`` of the two at most.
///
/// With h_i^2 |k_i| = a in both directions the errors above are, for triangles that are
/// equilateral in this metric, (1 + b) a / 12 at the centroid and a / 8 in the middle of an
/// edge. b is the signed ratio of the h_i^2 k_i: 1 or -1, or between where one size is bound by
/// ``ratio`` times the other. For a ratio of 1 it is the rule of ``chord_size``. The tensor with
/// these sizes is a function of the shape operator without regard to the order of k1 and k2, and so
/// as smooth as that at umbilics.
PrincipalSizes principal_chord_sizes(PrincipalCurvatures k, double chord, double ratio);

/// The same of triangles whose corners move until they lie nearer (src/patch/stretched_even_use.hpp).
PrincipalSizes evened_chord_sizes(PrincipalCurvatures k, double chord, double ratio);

/// The same on saddles, of triangles that form a lattice laid as ``lattice_edge`` (src/patch) has it.
PrincipalSizes saddle_lattice_sizes(PrincipalCurvatures k, double chord, double ratio);

/// At which dihedral angles are at most ``angle`` (degrees).
///
/// With h_i^2 |k_i| = a as above the slope jumps by a (3 - b) / (2 sqrt(3) h_i) across an edge
/// at right angles to direction i, the shorter h_i decides. Sizes that keep h_i |k_i| alike
/// would not do: the sag of a long edge tilts the narrow triangles beside it.
PrincipalSizes principal_angle_sizes(PrincipalCurvatures k, double angle, double ratio);

}  // namespace surfmesh
