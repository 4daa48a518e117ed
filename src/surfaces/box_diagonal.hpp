// The diagonal of the box around points.
#pragma once

#include <span>

#include "values/point.hpp"

namespace surfmesh {

/// Of the box around at least one point, to the last bit what geometry.boxes has in Python; scaled,
/// so that no square is too large or too small. No number where a coordinate is none.
[[nodiscard]] double box_diagonal(std::span<const Point3> points);

}  // namespace surfmesh
