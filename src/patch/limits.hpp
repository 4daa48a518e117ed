// What a patch is asked to keep to, and how small sizes may become for it.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "sizing/size_bounds.hpp"

namespace surfmesh {

/// A bend is sharp, and no size smaller, below this fraction of ``chord``.
inline constexpr double LEAST_OF_CHORD = 0.5;

/// Where ``min_size`` cuts off what is asked for, it is asked for up to this part of the size that is
/// there: for less another round is no help.
inline constexpr double WORTH_A_ROUND = 0.9;

/// A size that bounds none.
inline constexpr double NO_LARGEST = std::numeric_limits<double>::infinity();

/// What was asked for, in model units and degrees; nothing where there is no value.
struct AskedAccuracy {
    std::optional<double> chord, angle;
    double min_size = 0.0;
    std::optional<double> slope = {};  // growth per length that sizes lowered here are graded to
    bool is_width = false;        // ``chord`` is that of the whole band around the surface that a
                                  // triangle needs, on one side or on both
    bool keeps_lowered = false;   // nodes of the boundary keep sizes that were lowered there
    bool fewest = false;          // as few triangles as keep ``chord``, for more time
    double largest = NO_LARGEST;  // size that is asked for
};

/// Radius below which a surface is said to bend sharply: no triangle is small enough there.
inline double sharp_radius(const AskedAccuracy& asked, double diagonal) {
    return std::max(LEAST_OF_CHORD * asked.chord.value_or(0.0), FINEST_SIZE * diagonal);
}

}  // namespace surfmesh
