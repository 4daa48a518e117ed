// Triangles over which a surface surely hides nothing between its samples, by bounds of its second
// derivatives.
//
// Over a triangle T with normal n and corner p the surface lies e = n . (r - p) from the plane of T.
// At once: over the box of T in (u, v) e bends by no more than its second derivatives there say. In
// parts: T cut in four again and again; linear interpolation of e over a part with edges d_ij errs
// by no more than 1/2 sum l_i l_j |e'' along d_ij|, l barycentric. Along an edge of a long thin
// triangle the second derivatives cancel as they do on the surface; over its box they would not.
//
// In: triangles of one surface, what may hide over each, and what its samples have seen. Out: for
// each which of both says that no more does. (Moore, Kearfott, Cloud, "Introduction to Interval
// Analysis", SIAM 2009, chapter 6.)
#pragma once

#include <cstdint>
#include <span>

#include "surfaces/closest_point.hpp"
#include "surfaces/surface.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct SampledTriangles {
    std::span<const ParameterTriangle> uv;
    std::span<const Point3> corner, normal;  // one of the corners; of length 1
    std::span<const double> tolerance, seen;
};

enum class Bounded : std::uint8_t { NOT, IN_PARTS, AT_ONCE };

struct HiddenBounds {
    Array<Bounded> bounded;  // of each triangle
    SurfaceStatus status = SurfaceStatus::DONE;
};

/// levels: a triangle is cut in four so often.
HiddenBounds hidden_bounds(const Surface& surface, const SampledTriangles& triangles, int levels);

}  // namespace surfmesh
