// Triangles over which a surface surely hides nothing between its samples, by bounds of its second
// derivatives.
//
// Over a triangle T with normal n and corner p the surface lies e = n . (r - p) from the plane of T.
// Linear interpolation of e over a triangle with edges d_ij errs by no more than
// 1/2 sum l_i l_j |e'' along d_ij|, l barycentric. The samples of T are its corners and the middles
// of its edges among others: between them it errs by a quarter of that, more than they have seen.
// Bounds over a box around many triangles hold for each of them, so boxes get smaller where they
// have to: where intervals leave some, models of second derivatives around these (bend_models.hpp),
// then the box of T alone, over which e bends by no more than its second derivatives say. Triangles
// that follow each other in a mesh are neighbours as a rule; where they are not, each is alone. What
// is left is cut in four again and again. Along an edge of a long thin triangle the second
// derivatives cancel as they do on the surface; over its box they would not.
//
// In: triangles of one surface, what may hide over each, and what its samples have seen. Out: for
// each whether bounds say that no more does. (Moore, Kearfott, Cloud, "Introduction to Interval
// Analysis", SIAM 2009, chapter 6.)
#pragma once

#include <cstdint>
#include <span>

#include "quality/measured_mesh.hpp"
#include "surfaces/closest_point.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Rows of a mesh on one surface. Those without area hide nothing.
struct SampledTriangles {
    std::span<const std::int32_t> rows;
    std::span<const double> tolerance, seen;  // of each
    std::span<const std::uint8_t> whole;      // 1: all of its box counts, not the triangle alone
};

struct HiddenBounds {
    Array<std::uint8_t> bounded;  // of each triangle: 1 where nothing hides
    SurfaceStatus status = SurfaceStatus::DONE;
};

/// levels: a triangle is cut in four so often.
HiddenBounds hidden_bounds(const Surface& surface, const MeasuredMesh& mesh,
                           const SampledTriangles& triangles, int levels);

}  // namespace surfmesh
