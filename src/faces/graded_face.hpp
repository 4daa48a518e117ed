// A face of a CAD model whose sizes follow from its curvature and from those of its edges.
//
//     diagonal -> rules -> chart -> lattice? -> sides? -> cells as small as edges -> graded -> mesh
//
// Any surface but planes and cylinders, of which face_mesh.hpp knows more. Poles, sizes that depend on
// the direction and the caller's own are left to Python: what is out of the ordinary is a status.
#pragma once

#include <memory>

#include "faces/face_mesh.hpp"
#include "sizing/asked_rules.hpp"

namespace surfmesh {

/// What is known of the surface of a face before it is sampled.
struct KnownSurface {
    std::shared_ptr<const Surface> of_face;   // over the domain of the face
    std::shared_ptr<const Surface> over_box;  // the same over the box of its boundary
    std::array<bool, 2> is_steady;            // |r_u| is the same all along u, |r_v| along v
    int pieces;                               // smooth ones, over the box
};

/// No coedge of the boundary is degenerate, and the sizes come from no earlier round.
struct GradedFace {
    KnownSurface surface;
    std::shared_ptr<const FaceBoundary> boundary;
    std::shared_ptr<const AskedRules> asked;
    double slope;       // growth of the size per length, at most
    FaceManner manner;  // whether sizes are for a lattice is found out
};

/// ``unprepared`` where there is no size field, or a pole in it.
[[nodiscard]] FaceMesh mesh_graded(const GradedFace& face, const PatchHooks& hooks);

}  // namespace surfmesh
