// What a patch is asked to keep to, and how small sizes may become for it.
#pragma once

#include <algorithm>
#include <optional>

namespace surfmesh {

/// No size is smaller, as a fraction of the diagonal: at an apex the curvature is infinite.
inline constexpr double FINEST_SIZE = 1e-5;

/// ``angle`` asks for no smaller size, as a fraction of the diagonal: triangles about an apex are
/// bent by as much at any size.
inline constexpr double FINEST_BY_ANGLE = 2e-4;

/// A bend is sharp, and no size smaller, below this fraction of ``chord``.
inline constexpr double LEAST_OF_CHORD = 0.5;

/// Fraction of ``angle`` that two unit triangles may be bent by: on a sphere, where all edges are
/// alike and some triangles are larger; and for what depends on the direction, as few edges lie
/// worst.
inline constexpr double ROUND_RESERVE = 0.78, BENT_RESERVE = 0.94;

/// What was asked for, in model units and degrees; nothing where there is no value.
struct AskedAccuracy {
    std::optional<double> chord, angle;
    double min_size = 0.0;
};

constexpr double radians(double degrees) { return degrees * (3.141592653589793 / 180.0); }

/// Radius below which a surface is said to bend sharply: no triangle is small enough there.
inline double sharp_radius(const AskedAccuracy& asked, double diagonal) {
    return std::max(LEAST_OF_CHORD * asked.chord.value_or(0.0), FINEST_SIZE * diagonal);
}

}  // namespace surfmesh
