// Can a mesh be deformed into its surface through space?
//
// h(x) = r(psi(x)) - x is how a point of the mesh moves to its piece. Where for some constant c < 1
//
//     |h(x) - h(y)| <= c |x - y|      for all points x, y of the mesh,
//
// x + t h(x), t from 0 to 1, is such a deformation: h has an extension to all of space with the same
// constant (Kirszbraun, Fund. Math. 22 (1934), 77-108), and x -> x + t h(x) is then a homeomorphism of
// space for each t (Banach's theorem). The proof that it holds is made of two parts:
//
//     a-----b     points of two triangles at a vertex v are joined by a path over the star of v, seen
//    / \ . / \    along n no longer than |x - y| / cos(H / 2), H the sum of what the corners of the
//   f---v---c     star turn inwards; over T it is 1 / cos(T, n) times as long, and h changes by no more
//    \ / \ /      than slope(T) times that
//     e---d
//                 points of other triangles are farther apart than both move
//
// In: a mesh, how far points of each triangle move at most, the largest slope of h there. Out: that it
// holds, or where it is not known to. Nothing is changed.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

enum class IsotopyFault {
    NONE,
    BENT,  // at a vertex: pieces may change too fast for its star, or that is no graph
    NEAR,  // two triangles that share no vertex may move into each other
};

struct IsotopyProof {
    IsotopyFault fault;
    std::int32_t first, second;  // the vertex, or the two triangles
};

struct MovedMesh {
    std::span<const Point3> points;
    std::span<const std::int32_t> vertices;  // (3 m) of the triangles
    std::span<const double> away, slope;     // (m)
};

[[nodiscard]] IsotopyProof prove_isotopy(const MovedMesh& mesh);

/// All vertices where the first part is not known to hold.
[[nodiscard]] Array<std::int32_t> bent_stars(const MovedMesh& mesh);

}  // namespace surfmesh
