// Ranges of waves whose factors lie in intervals: what is turned about an axis.
#pragma once

#include "surfaces/enclosure.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh {

inline constexpr double SWEPT_ROUNDING =
    0x1p-46;  // more than any of the sums below, of their terms

inline Interval widened_by(Interval a, double margin) { return {a.lo - margin, a.hi + margin}; }

/// a cos u + b sin u for ranges of a and b: linear in these, so extreme at their ends.
inline Interval wave_of(Interval a, Interval b, Interval u) {
    using outward::hull;
    return hull(hull(wave_range(a.lo, b.lo, u), wave_range(a.lo, b.hi, u)),
                hull(wave_range(a.hi, b.lo, u), wave_range(a.hi, b.hi, u)));
}

}  // namespace surfmesh
