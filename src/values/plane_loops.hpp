// Loops of the plane, one after the other.
#pragma once

#include <cstdint>
#include <span>

#include "values/point.hpp"

namespace surfmesh {

/// Corners of loops in one row, not closed: those of loop k from first[k] to first[k + 1].
struct PlaneLoops {
    std::span<const Point2> corners;
    std::span<const std::int64_t> first;
};

}  // namespace surfmesh
