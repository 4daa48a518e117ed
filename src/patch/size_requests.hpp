// Upper bounds of the size, for another round, where the optimiser could not mend a patch.
#pragma once

#include "patch/patch_state.hpp"
#include "patch/schedule.hpp"

namespace surfmesh {

/// At each of the points the size is to be at most this.
struct SizeLimitArrays {
    Array<Point3> points;
    Array<double> sizes;
    Array<Point2> uv;                // of the points; none where sizes are isotropic
    Array<MetricRoot3> metric_root;  // W of the size asked for; none where sizes are isotropic
};

/// What a patch asks for, by what is not right there; nothing where all is.
struct SizeRequests {
    std::optional<SizeLimitArrays> chord, folds, angle;
};

/// What would mend what the optimiser has left.
///
/// off_surface: marks of the nodes that lie off the surface themselves, or none: for the triangles
/// at them smaller sizes are no help. first: as of ``optimise``; later rounds ask for no more where
/// ``min_size`` binds and sizes are near to it: round after round would find some.
SizeRequests size_requests(PatchState& state, const Unmended& left,
                           std::span<const std::uint8_t> off_surface, bool first);

}  // namespace surfmesh
