// How far the surface's curves over the sides of triangles are from these.
//
//        o----o----o        points of the curve, how far they are from the side at most, and what it
//      .'           `.      may leave it by between two of them
//     a---------------b
//
// Bounds over a whole triangle say much less where it runs half round a pole.
//
// In: the triangles of one face, and their bounds. Out: distances of sides, each computed once, when it is
// asked for. Nothing is changed.
#pragma once

#include <cstdint>
#include <span>

#include "proof/triangle_bounds.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// The triangles of one face: corners, parameters, vertices (3 m), opposite half-edges (3 m), and
/// what is proved of them so far.
struct ProofMesh {
    std::span<const SpaceCorners> corners;
    std::span<const PlaneCorners> uv;
    std::span<const PlaneBends> bends;
    std::span<const std::int32_t> vertices, twins;
    std::span<const TriangleBounds> bounds;
};

class SideDistances {
  public:
    SideDistances(const Surface& surface, const ProofMesh& mesh);

    /// Of half-edge h; infinite where the surface says nothing.
    double at(std::size_t h);

  private:
    [[nodiscard]] double computed(std::size_t h);

    const Surface& surface_;
    ProofMesh mesh_;
    Array<double> known_;  // by half-edge; less than 0: not yet
    Array<Point2> uv_;
    Array<EnclosedPoint> points_;
};

}  // namespace surfmesh
