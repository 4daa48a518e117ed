// How far a piece of a curve is at most from the segment between its ends, both ways, proved.
//
// In: a curve, the parameters of pieces' ends, and the ends of segments in space. Out: a bound
// each, infinite where the curve has none. A piece is cut into parts, each within dt^2 sup |c''| / 8
// of its chord, so that it is no farther from the segment than the ends of the parts are and that.
// Where that says little, as c'' is large over short spans of an approximation, a part is no farther
// than its ranges along the segment and across it say.
// The other way a point of the segment has a point of the curve over it, which is as near: the curve
// runs from end to end. How far the ends are off c is added.
#pragma once

#include <array>
#include <span>

#include "surfaces/curve.hpp"
#include "values/array.hpp"

namespace surfmesh {

using SegmentEnds = std::array<Point3, 2>;
using ParameterEnds = std::array<double, 2>;

/// Bounds of pieces, each cut into so many ``parts``.
Array<double> curve_bounds(const Curve& curve, std::span<const ParameterEnds> t,
                           std::span<const SegmentEnds> ends, int parts);

}  // namespace surfmesh
