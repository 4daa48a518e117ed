// A box of the plane is packed: from its middle, or, where it is large, from a line both ways.
//
// The line goes through the box where it has as much to be packed on one side as on the other, along
// the axis that needs fewer circles. Circles stand on it each touching the next; the fronts of both
// halves grow away from it, side by side where there are two threads. Neither looks at the other,
// and whether there are halves depends on how many circles are expected alone: the same circles
// for any number of threads.
#pragma once

#include <optional>

#include "packing/packing.hpp"

namespace surfmesh {

/// From so many circles on a box is packed in halves.
inline constexpr std::size_t CIRCLES_FOR_HALVES = 50'000;

/// Pack circles until the front has left the box. ``watch`` is asked by one thread at a time.
///
/// edge: a direction of the plane that edges are to have. The line runs along an axis on which they
/// lie then; where there is none the box is packed from its middle.
/// ``counts.halves`` says whether it was done in halves; then there is no front at the end. A box in
/// which no line can be laid, or whose halves make no convex whole, is packed from its middle.
[[nodiscard]] Packing pack_box(const CircleSizes& sizes, Point2 low, Point2 high,
                               std::size_t expected, const Watch& watch = {},
                               std::optional<Point2> edge = {});

}  // namespace surfmesh
