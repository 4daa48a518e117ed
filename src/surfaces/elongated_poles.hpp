// Poles of a surface about which lines of constant v (or u) are long and thin, and what is made of
// them: angles about them, and the scaling of the axis that runs there.
//
// In: a surface, and its chart axis by axis. A pole is a side that is one point in space. Round it,
// a little way off in the plane, runs a line whose points are farther from the pole on one side than
// on the other; where the farthest is so many times as far as the nearest, the pole is elongated.
// A pole from which some points do not move away is singular, and left alone.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "surfaces/chart.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

struct ElongatedPoles {
    std::size_t axis;             // that runs to them: 0 for u
    std::array<bool, 2> is_pole;  // at its beginning, at its end; one of them is elongated
    Array<double> turned;  // the angle about them at even steps of the other parameter, their mean
};

/// None where no pole is elongated, or the surface cannot be read.
[[nodiscard]] std::optional<ElongatedPoles> find_elongated_poles(SurfaceReader& surface,
                                                                 const Chart& chart);

/// The scaling for a chart whose axes are made.
[[nodiscard]] PoleScaling scaling_by(SurfaceReader& surface, const Chart& chart,
                                     const ElongatedPoles& poles);

}  // namespace surfmesh
