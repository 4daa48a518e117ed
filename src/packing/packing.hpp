// Circle packing by an advancing front (Wang, Ming and Lo 2007, section 2) in a metric.
//
// In: size tensors on a background, or radii as they are drawn; where to start and when to end.
// Out: circles, the triangulation of their centres, and the front. The circle of a vertex is an
// ellipse in the plane, given by its size tensor; two touch at metric length 1, and the paper's
// closeness beta is min(l, 1/l). The unbounded plane is triangulated at every moment: what lies
// inside the front is final, what lies outside is a coarse triangulation of the front's vertices.
// That outer part answers the paper's questions locally and exactly: which circles are near a
// candidate (its neighbours in the outer part, on both sides of the front and across a narrow gap
// alike), is the candidate visible from its supports, and which polygon is left over when it is
// not. Hence every triangle is positively oriented and the front is one simple loop, always.
#pragma once

#include "packing/circle_sizes.hpp"
#include "packing/packing_state.hpp"

namespace surfmesh {

/// Appends ``count`` radii to those drawn so far; false when there are to be no more circles.
using Draw = std::function<bool(std::size_t count, Array<double>& drawn)>;

/// Pack circles of the background's sizes until the front has left the box, or enough are there
/// (2.4). ``expected``: about how many there will be, so that arrays need not grow. How it ended
/// is in the packing.
[[nodiscard]] Packing pack(const CircleSizes& sizes, const PackingLimits& limits,
                           std::size_t expected, const Watch& watch = {});

/// The same for circles of drawn radii.
[[nodiscard]] Packing pack_discs(const Draw& draw, const PackingLimits& limits,
                                 std::size_t expected, const Watch& watch = {});

/// A packing without circles, with room for about ``expected``.
[[nodiscard]] Packing empty_packing(const PackingLimits& limits, std::size_t expected);

/// Advance the front of circles of the background's sizes until there is no more to do.
[[nodiscard]] PackingEnd advance_front(Packing& p, const CircleSizes& sizes, const Watch& watch);

}  // namespace surfmesh
