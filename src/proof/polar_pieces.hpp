// How triangles at a pole move to the surface, along rays from it.
//
//     s=0   P   s=1        In (u, v) the pole is a side of the domain, w = w0. The piece of the triangle
//      |`-._|_.-'|         P A B lies between that and the curve over A B:
//      |  t |    |
//      |    |    |             r(b(s), w0 + t g(s)),   over   P + t ((1 - s) (A - P) + s (B - P)),
//      A ---b--- B
//                          for the curve (b, w0 + g) of s over A B, which that triangle's neighbour has too.
//
// Neighbours round the pole have one ray over their side, whatever (u, v) they have of the pole. With
// e = B - A and d(s) = A - P + s e the two differ, h, by
//
//     h'(d) = g r_w - d,      h'(e) = b' g m + g' r_w - e,      m = r_b / (t g), a mean of r_bw
//
// as r_b = 0 at the pole: so h' is bounded by r_w and r_bw over boxes of (u, v), pole and all.
//
// In: triangles, the curves over their sides off the pole. Out: bounds of |h'| and |h|. Nothing is changed.
#pragma once

#include <array>
#include <span>

#include "proof/plane_piece.hpp"
#include "surfaces/fourth_derivatives.hpp"

namespace surfmesh {

/// A side of the domain that is one point: u, or v, has the value there.
struct PoleSide {
    bool is_v;
    double value;
};

struct PolarPieces {
    std::span<const SpaceCorners> corners;  // (m) pole first
    std::span<const PlaneCorners>
        base;  // (m) Bezier points of the curve from the second corner to the third
    PoleSide pole;
};

/// Largest |h'(w)| for unit w, and |h|; infinite where that is not known.
struct PolarMove {
    double slope, away;
};

SurfaceStatus polar_moves(const Surface& surface, const FourthDerivatives& derivatives,
                          const PolarPieces& pieces, std::span<PolarMove> out);

}  // namespace surfmesh
