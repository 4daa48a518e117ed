// What surfaces prove of themselves: bounds with all round-off in them.
//
// A surface says how far its computed points are at most from r(u, v), and bounds how it bends over
// a cell of the (u, v) plane, along three directions d of space:
//
//     d . r_uu     d . r_uv     d . r_vv          in an interval each, whatever (u, v) of the cell
//
// Along directions the bounds are far tighter than by coordinates: r_uu of a sphere turns within a
// cell, and hardly changes along the normal. Bounds are infinite where nothing is known.
#pragma once

#include <array>

#include "surfaces/interval.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// Points as computed, and how far each coordinate is off at most.
struct EnclosedPoint {
    Point3 value;
    double error;
};

/// Three directions, of at most unit length but for rounding.
using Directions = std::array<Point3, 3>;

inline constexpr Directions AXES = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

/// Bounds of second derivatives along the three directions; and of how much r_u and r_v jump, in
/// absolute value and in all, at the creases u = const and v = const of a cell that is gone through.
struct Bends {
    std::array<Interval, 3> uu, uv, vv;
    std::array<double, 3> jump_u{}, jump_v{};
};

inline constexpr Interval UNBOUNDED{-intervals::INFINITE, intervals::INFINITE};
inline constexpr Bends UNBOUNDED_BENDS = {{UNBOUNDED, UNBOUNDED, UNBOUNDED},
                                          {UNBOUNDED, UNBOUNDED, UNBOUNDED},
                                          {UNBOUNDED, UNBOUNDED, UNBOUNDED},
                                          {},
                                          {}};

/// A vector that lies in a box.
struct BoxedVector {
    Interval x, y, z;
};

/// Along a direction.
Interval along(const Point3& direction, const BoxedVector& vector);

/// The waves a cos t + b sin t for t from first to last.
Interval wave_range(double a, double b, Interval t);

}  // namespace surfmesh
