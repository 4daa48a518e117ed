// Which points lie within loops of the plane, by even-odd, decided exactly.
//
//        .-----.         a point is within a loop if a ray from it to the right crosses the loop
//        |  x--|-->      an odd number of times; on the loop itself it is not within. Of several
//        '-----'         loops it counts in how many it lies.
//
// Loop after loop, its points are passed upwards with the segments at their height at hand.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/plane_loops.hpp"

namespace surfmesh {

/// 1 for each point within an odd number of loops; loops of fewer than three corners hold nothing.
Array<std::uint8_t> inside_loops(const PlaneLoops& loops, std::span<const Point2> points);

}  // namespace surfmesh
