// Circles along a straight line, each touching the next: a large packing grows from it both ways.
#pragma once

#include <cstddef>

#include "packing/circle_sizes.hpp"
#include "packing/packing_state.hpp"

namespace surfmesh {

/// The line through the middle of a box in the direction of an axis: (1, 0) or (0, 1).
struct StraightLine {
    Point2 through, direction;
};

/// Circles of the background's sizes along the line, from before the box to beyond it, in order.
///
/// The first and the last touch none: they lie so far out that no circle that the box needs does.
/// None where more than ``most`` would be needed, or where sizes are no numbers.
Array<Circle> circles_along(const CircleSizes& sizes, const StraightLine& line, Point2 low,
                            Point2 high, std::size_t most);

}  // namespace surfmesh
