// A closer look at triangles whose pieces of the surface are shifted far within their planes.
//
// The piece of T is cut into cells K, whose corners are computed; K lies within its sag of the
// triangle through these. Seen along the normal of T, every point of K lies over T or over one of
// the triangles around it (all that share a vertex with T), and nearer to the mesh than the highest
// of K over the plane of any of these that K may lie over:
//
//      K   .---.               H(K, T') = max over corners |n' . (r - p')| + sag of K along n'
//        .'     `.
//     __o____o____o__          bound(T) = max over K and T' of H(K, T') / cos d
//        T    T'
//
// The other way, a point of T is covered by a cell of T or of a triangle around it, which is as
// near. Both need that the boundary of the ring, seen along the normal, lies farther from T than
// the feet of its piece, and than the boundary is shifted; and that no normal there is turned by
// more than 60 degrees. What lies beyond a rim is near to that: its distance counts, as does that
// of the curve over the rim. Where one ring of triangles does not suffice there are two. The proof
// is in docs/proof.md.
//
// Before that |r - L| itself is looked at, point by point: where pieces are hardly shifted that is
// enough, whatever the triangles around.
//
// In: the triangles of one face, their bounds so far. Out: better bounds, where there are such.
#pragma once

#include <cstdint>
#include <span>

#include "proof/triangle_ring.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

/// Triangles of the (u, v) plane between two neighbours whose parameters differ at a pole. In space
/// two of their corners are one, so that the mesh has none; each belongs to a triangle beside it.
///
///      p0 ------ p1        the pole, a side of the domain
///       \  gap  /
///    T0  \     /  T1
///            a
struct PoleGaps {
    std::span<const PlaneCorners> uv;
    std::span<const std::int32_t> owner;     // ascending
    std::span<const TriangleBounds> bounds;  // along the axes of the owner
};

/// Look at ``which`` triangles until their bound is within their limit, with at most 4^levels cells
/// each. bound (m,): lowered where the look shows less. Status as the surface says.
SurfaceStatus look_closer(const Surface& surface, const ProofMesh& mesh, const PoleGaps& gaps,
                          std::span<const std::int32_t> which, std::span<const double> limits,
                          int levels, std::span<double> bound);

}  // namespace surfmesh
