// A unit vector n = N / |N| and its derivatives to the second order, by boxes of N and of its own;
// and a frame in which these are narrow.
//
// With s = |N| and N = s n the derivatives of n follow from those of N by the product rule:
//
//     N_i  = s_i n + s n_i                           s_i  = n . N_i
//     N_ij = s_ij n + s_i n_j + s_j n_i + s n_ij     s_ij = n_j . N_i + n . N_ij
//
// Along a direction d = c n + t, with any number c, the second derivatives of n are
//
//     d . n_ij = t . n_ij - c n_i . n_j         as n . n_i = 0
//
// so that what is known of n_ij by coordinates counts by t, which is small along n.
#pragma once

#include "surfaces/boxed_vectors.hpp"

namespace surfmesh {

inline constexpr double FRAME_ROUNDING =
    0x1p-40;  // more than a frame is off a rotation, several times

/// Unit vectors at right angles, the last of them along a x b, to rounding; the axes of the coordinates
/// where these hardly differ.
Directions frame_at(Point3 a, Point3 b);

/// Directions by their coordinates in a frame.
Directions in_frame(const Directions& frame, const Directions& directions);

/// What is left of a vector across the unit vector n, over a length: its x is
/// a_x (n_y^2 + n_z^2) - n_x (a_y n_y + a_z n_z), and so on.
BoxedVector across(const BoxedVector& a, const BoxedVector& n, Interval per_length);

/// The derivatives of N and n along one parameter.
struct FirstOfVector {
    BoxedVector N, n;
};

struct UnitVector {
    BoxedVector n;
    Interval per_length;  // 1 / |N|

    [[nodiscard]] BoxedVector first(const BoxedVector& N_i) const;
    [[nodiscard]] BoxedVector second(const BoxedVector& N_ij, const FirstOfVector& i,
                                     const FirstOfVector& j) const;
};

/// False where N may vanish.
[[nodiscard]] bool bound_unit_vector(const BoxedVector& N, UnitVector& out);

/// A direction split by the unit vector in the middle.
struct SplitDirection {
    Point3 d;
    double c;
    BoxedVector t;

    SplitDirection(const Point3& direction, const BoxedVector& n);
    /// d . n_ij of a second derivative, with n_i . n_j.
    [[nodiscard]] Interval along_second(const BoxedVector& n_ij, Interval product) const;
};

}  // namespace surfmesh
