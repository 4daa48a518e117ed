// Patches of a mesh that cannot meet themselves, as they lie over a coordinate plane like graphs.
//
//      o---o---o       All triangles of a patch turn the same way seen along an axis, so that over a
//     / \ / \ / \      place of that plane there are as many of them as the rim of the patch winds
//    o---o---o---o     round it: as far as the rim crosses and touches itself nowhere and winds
//     \ / \ /          round nothing twice, there is one, and no two triangles have a point in
//      o---o   rim     common but a corner or a side that they share.
//
// An open surface may be one as a whole, over the plane that the sum of its normals says. Otherwise
// a patch is grown from triangle to triangle across edges of two that run along it in opposite
// directions: from one in a plane across an axis within that plane, from others over no such plane, as
// what lies beside a flat patch may be on one side of it (supporting_planes.hpp). Its rim is swept
// once, edges in their order over the sweep line, by exact predicates.
// A patch that is not proved is none: whoever asks compares its triangles pair by pair.
//
// In: points and triangles, and the half-edges beside each other. Nothing changes. Normals of half a
// turn at most and a simple rim: Volino, Magnenat-Thalmann, "Efficient self-collision detection on
// smoothly discretized surface animations using geometrical shape regularity", Eurographics 1994,
// section 2; the sweep is that of Shamos & Hoey, "Geometric intersection problems", FOCS 1976.
#pragma once

#include <cstdint>
#include <span>

#include "space/triangle_corners.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct GraphPatches {
    Array<std::int32_t> of_triangles;  // the number of each one's, or NIL
    Array<std::int32_t> flat_across;   // of each patch the axis that its plane is across, or NIL
    Array<HalfEdge> rims;              // half-edges beside which there is nothing of their patch

    [[nodiscard]] std::int32_t of(HalfEdge e) const { return e == NIL ? NIL : of_triangles[e / 3]; }
};

/// twins: of each half-edge 3 t + k the one that runs along the same edge the other way, or NIL.
GraphPatches graph_patches(std::span<const Point3> points,
                           std::span<const TriangleCorners> triangles,
                           std::span<const HalfEdge> twins);

}  // namespace surfmesh
