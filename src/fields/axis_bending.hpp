// Evaluation of the monotone cubic that bends one axis of the scaled plane.
//
// In: scaled coordinates, and the parameter and its derivative at knots that are evenly spaced
// from 0 to the extent of the axis. Out: the parameter and its derivative at the coordinates.
// Linear outside [0, extent].
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "values/array.hpp"

namespace surfmesh {

struct BentAxis {
    double extent;                   // finite and positive
    std::span<const double> knots;   // two at least: the parameter
    std::span<const double> slopes;  // its derivative
};

struct ParameterAndRate {
    double parameter, rate;
};

/// Cubic Hermite interpolation at x.
inline ParameterAndRate bend(const BentAxis& axis, double x) {
    const auto cells = static_cast<std::int64_t>(axis.knots.size()) - 1;
    const double step = axis.extent / static_cast<double>(cells);
    // what is not a number is left to the last line
    const double inside = std::min(std::max(0.0, x), axis.extent);
    const std::int64_t i = std::min(static_cast<std::int64_t>(inside / step), cells - 1);
    const double t = inside / step - static_cast<double>(i);
    const double m = step * axis.slopes[i], n = step * axis.slopes[i + 1];
    const double d = axis.knots[i + 1] - axis.knots[i];
    const double b = 3.0 * d - 2.0 * m - n, c = m + n - 2.0 * d;
    const double rate = (m + t * (2.0 * b + 3.0 * t * c)) / step;
    return {axis.knots[i] + t * (m + t * (b + t * c)) + (x - inside) * rate, rate};
}

}  // namespace surfmesh
