// The chart of a surface from its speeds: see chart.hpp.
//
// On a CAD cylinder u is radians and v millimetres; on a badly parametrised surface the speed
// |r_u| changes a thousandfold along u. Both would make circles in (u, v) grotesque. So x is a
// function of u alone, with dx/du the mean over v of |r_u|, and y likewise of v: lengths of the
// surface's own order, on which predicates keep their digits. Where the mean speed hardly changes
// the function is linear, otherwise a monotone cubic spline, once differentiable. Where speeds
// have no bound (square roots) it is a function of the bent parameter instead. About elongated
// poles the axis that runs there is scaled by the distance from them: see pole_scaling.hpp.
#pragma once

#include <array>
#include <span>

#include "surfaces/chart.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Points along an axis at which speeds are taken, at most; and of a smooth piece of a surface.
inline constexpr std::size_t CHART_SAMPLES = 257, CHART_SAMPLES_OF_PIECE = 32;

/// The same of a surface of so many smooth pieces.
constexpr std::size_t chart_samples(std::size_t pieces) {
    return pieces < CHART_SAMPLES / CHART_SAMPLES_OF_PIECE ? CHART_SAMPLES_OF_PIECE * pieces + 1
                                                           : CHART_SAMPLES;
}

/// What is known of an axis before it is sampled.
struct KnownAxis {
    bool steady;                          // the speed is the same all along it
    Array<BentPiece> pieces;              // where the speed has no bound, or none
    std::size_t samples = CHART_SAMPLES;  // along it, at least two
};

/// Sampled where nothing is known; the reader says whether it could be. `to_poles`: elongated poles
/// are looked for, which is for surfaces over a whole rectangle.
Chart chart_of(SurfaceReader& surface, const std::array<KnownAxis, 2>& known,
               bool to_poles = false);

/// Stretched by the same factor everywhere.
ChartAxis linear_axis(double low, double high, double speed);

}  // namespace surfmesh
