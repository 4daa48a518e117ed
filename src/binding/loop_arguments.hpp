// Loops of the plane as numpy passes them: corners in one row, and where each loop begins.
#pragma once

#include <algorithm>
#include <cmath>

#include "binding/arrays.hpp"
#include "values/plane_loops.hpp"

namespace surfmesh::binding {

/// corners (n, 2), finite; first (k + 1,): from 0 to n, none smaller than the one before.
inline PlaneLoops plane_loops(const Points2& corners, const Vector<std::int64_t>& first) {
    const auto offsets = rows<std::int64_t>(first);
    if (offsets.empty() || offsets.front() != 0 ||
        offsets.back() != static_cast<std::int64_t>(corners.shape(0)) ||
        !std::is_sorted(offsets.begin(), offsets.end()))
        throw nb::value_error("first has no offsets of the corners");
    if (!std::all_of(corners.data(), corners.data() + corners.size(),
                     [](double x) { return std::isfinite(x); }))
        throw nb::value_error("a corner of a loop is not finite");
    return {rows<Point2>(corners), offsets};
}

}  // namespace surfmesh::binding
