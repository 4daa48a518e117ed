// Corners of triangles whose vertices lie far from r(u, v): where vertices are asked to lie on their
// surfaces they do so to rounding.
//
// In: a mesh on its surfaces, and triangles that are left out. Out: of each place in (u, v) that the
// others use one corner, the last, where that is farther than a limit; a surface that fails is named.
#pragma once

#include <cstdint>
#include <span>

#include "quality/measured_mesh.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

struct FarCorners {
    Array<HalfEdge> half_edges;  // 3 t + k for corner k of triangle t, by the places in (u, v)
    std::int32_t failed = NIL;   // number of a surface, then nothing else counts
};

FarCorners far_corners(const MeasuredMesh& mesh, std::span<const std::uint8_t> left_out,
                       double limit);

}  // namespace surfmesh
