// How far a triangle is at most from its piece of the surface, proved.
//
// A triangle with corners r(u_i) stands for the piece r(u) over the triangle of the u_i in the (u, v)
// plane, whose sides may be bent (plane_piece.hpp: then r is r(psi) here, u of the straight one). With barycentric coordinates l of u, edges e_ij = u_j - u_i and any vector d,
//
//     | d . (r - L) |  <=  1/2 sum_{i<j} l_i l_j  sup | d . (r_uu du^2 + 2 r_uv du dv + r_vv dv^2) |
//
// with L the linear interpolant, (du, dv) = e_ij and the supremum over the triangle. (Write
// v_i - x as the sum of l_j (v_i - v_j) in sum l_i (f(v_i) - f(x)), and join the terms ij and ji;
// S. Waldron, The error in linear interpolation at the vertices of a simplex, SIAM J. Numer. Anal.
// 35 (1998), 1191-1200.) The suprema come from the surface's proved bounds over boxes around the
// triangle, or around the 4, 16, ... that it is cut into; of bent ones from corners alone
// (smooth_bounds.hpp).
//
// In: corners in space and in (u, v); how far a corner is off r(u_i) at most. Out: numbers for
// ring_bounds.hpp. Nothing is changed; what a surface cannot bound comes out infinite.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "proof/plane_piece.hpp"
#include "surfaces/surface.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Bounds over one triangle; side k runs from corner k to corner k + 1. Lengths.
struct TriangleBounds {
    double height;                  // of the piece over the triangle's plane
    std::array<double, 3> outward;  // how far the piece over a side leaves it within the plane
    std::array<double, 3> rim;      // how far the piece at a side is from it at most
    double shift;                   // the largest of |r''(e, e)| / 2: how far points move within
    double whole;                   // of |r - L|, whatever the shapes
    double corner;                  // how far a corner is off r(u_i)
    // what a side has to do with: of ring_bounds.hpp
    std::array<double, 3> inner;   // d . r''(e, e) / 2 across side k, of the other two sides e
    std::array<double, 3> beside;  // height of the piece where it lies beyond side k
    std::array<double, 3> steep;   // what a distance inside side k adds to that, of the distance
    std::array<double, 3> along;   // d . r''(e, e) / 2 along side k, of itself
    std::array<double, 3> others;  // and the larger of the other two
    double bend;                   // the largest of n . r''(e, e) / 2
    double slope;                  // the largest |(r' - L')(w)| for unit w
    // for the 4^j cells that the piece is cut into, times 4^-j: height and distance point by point
    double cell_height, cell_whole;
};

/// Bit k: side k is a rim of the surface, or of a face.
using RimSides = std::uint8_t;

/// Triangles (m), their corners in space and in (u, v), what they should keep to, their rims.
struct ProofRequest {
    std::span<const SpaceCorners> corners;
    std::span<const PlaneCorners> uv;
    std::span<const PlaneBends> bends;
    std::span<const double> limits;
    std::span<const RimSides> rims;
    // false: the corners give the plane alone, and r(u_i) lies elsewhere
    bool corners_are_on_surface;
    double slope;  // what slopes should keep to
    // of quadratic triangles; none: they are straight
    std::span<const SpaceBends> curved;

    [[nodiscard]] SpaceBends curve(std::size_t t) const {
        return curved.empty() ? SpaceBends{} : curved[t];
    }
    [[nodiscard]] PlanePiece piece(std::size_t t) const { return {uv[t], bends[t]}; }

    [[nodiscard]] ProofRequest part(std::size_t start, std::size_t count) const {
        return {corners.subspan(start, count),
                uv.subspan(start, count),
                bends.subspan(start, count),
                limits.subspan(start, count),
                rims.subspan(start, count),
                corners_are_on_surface,
                slope,
                curved.empty() ? curved : curved.subspan(start, count)};
    }
};

/// Bounds of each triangle into ``out``; of quadratic ones ``whole`` alone. Those beyond their limit, by height or at a rim, or beyond
/// the slope, are cut further, at most ``depth`` times. FAILED and UNKNOWN as the surface says.
SurfaceStatus triangle_bounds(const Surface& surface, const ProofRequest& asked, int depth,
                              std::span<TriangleBounds> out);

}  // namespace surfmesh
