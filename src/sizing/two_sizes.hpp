// Two sizes at a place, along two directions at right angles, and how limits lower them.
//
//      long, along `along`         a limit holds in its own directions: either size is lowered
// <------------------>             until the metric keeps to it, whichever by less
//         ^ size
//         v
#pragma once

#include "sizing/rim_sizes.hpp"
#include "sizing/size_limits.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// Ratio of two sizes up to which their directions do not matter.
inline constexpr double ROUND = 1.5;

struct TwoSizes {
    Point3 normal;  // unit, zero where it is not known
    Point3 along;   // unit tangent
    double size;    // the shorter one, at right angles to `along`
    double longer;
    double anisotropy;  // largest ratio of the two

    [[nodiscard]] bool is_round() const { return longer <= ROUND * size; }
    /// Lower the sizes to what a rim allows that passes there, nothing below `least`.
    void lower_to_rim(const RimSize& rim, double least);
    /// Lower them to limits that allow less than the longer one, likewise.
    void lower_to(const SizeLimits::Here& limits, double least);
    /// The same within limits, none of which goes below `least`.
    ///
    /// Where the shorter size is lowered the shape of the metric is kept. Where the metric is
    /// round, or nearly so, the direction is that of the limits.
    [[nodiscard]] TwoSizes limited(const SizeLimits::Here& limits, double least) const;
};

}  // namespace surfmesh
