// How far triangles and their pieces of the surface are from each other at most, both ways.
//
// A foot on a triangle's plane may lie over a neighbour, so the statement is made for a triangle
// with its three neighbours:
//
//     every point of the piece of T lies within bound(T) of T or a neighbour;
//     every point of T lies within bound(T), or a neighbour's, of the piece of T or a neighbour's.
//
//          T'  .-'        piece over T: at most h above its plane, at most s across the side; there
//     T  ____.-'  d       T' is s tan d away from T's plane. The other way x of T may be covered by
//            side         the piece of T' alone: h' (1 + sin^2 d) / cos d + s' sin d.
//
// It holds where points move little within the planes (shift at most a quarter of the heights, and
// less than the neighbours' angles allow), no angle is above 120 degrees and none between planes
// above 50: then the pieces over T and its neighbours, seen along T's normal, cover T (the boundary
// winds round each of its points). At a rim the piece's own distance from the side counts. Where a
// condition fails the bound is that of |r - L|, point by point. The proof is in docs/proof.md.
//
// Where |r - L| is within the limit, and little more than a height, below which no bound can be with
// neighbours, it counts at once.
//
// In: a mesh, its triangles' bounds, what they should keep to. Out: a bound each, and where it is of
// which kind.
#pragma once

#include <cstdint>
#include <span>

#include "proof/triangle_bounds.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

struct RingBounds {
    Array<double> bound;          // (m,) infinite where nothing is known
    Array<std::uint8_t> by_ring;  // (m,) 1: with the neighbours; 0: point by point
};

/// twins (3 m,): half-edge 3 t + k lies opposite to which; NIL at rims.
RingBounds ring_bounds(std::span<const SpaceCorners> corners,
                       std::span<const std::int32_t> vertices, std::span<const std::int32_t> twins,
                       std::span<const TriangleBounds> bounds, std::span<const double> limits);

}  // namespace surfmesh
