// Which pieces may cover a triangle that was looked at with those around it, and how near they are.
//
// A point of T is covered, seen along its normal, by a piece of T or of a triangle around it. If that
// was looked at in the same way, the heights of its cells over T are in its bound; else it is near
// to the mesh in another way, b, and no farther from T along the normal than
//
//        r(x) o.                   b / cos D
//             | ` .  b
//             |     ` o            the mesh is a graph over T's plane here, no steeper than D
//        q ___|____.-'
//
// where the disc of radius b around T lies within the ring. Where that is too much, the triangle has
// to be looked at too.
//
// In: a mesh, its bounds, which were found with how many rings. Out: triangles to be looked at; then
// bounds of which the largest around a triangle counts what covers it.
#pragma once

#include <span>

#include "proof/triangle_ring.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct LookedAt {
    std::span<const std::uint8_t> layers;  // (m,) of triangles around, with which the bound holds
    std::span<const double> over_ring;     // (m,) heights of pieces over those around them
    std::span<const double> without;       // (m,) the bound without them
    std::span<const double> whole;         // (m,) point by point, of gaps at poles too
};

/// Triangles that may cover those with rings, where what is known of them does not suffice.
Array<std::int32_t> covering_triangles(const ProofMesh& mesh,
                                       const TrianglesAtVertices& at_vertices, SideDistances& sides,
                                       const LookedAt& looked, std::span<const double> limits,
                                       std::span<const double> bound);

/// bound (m,): raised where a piece covers a triangle around it from farther than both their bounds;
/// without rings where that is not known.
void count_covering(const ProofMesh& mesh, const TrianglesAtVertices& at_vertices,
                    SideDistances& sides, const LookedAt& looked, std::span<double> bound);

}  // namespace surfmesh
