// How much area the faces of a finished mesh lose or win by the distance of its triangles from the
// surface.
//
// In: triangles on faces, their areas and distances. Out: of the area of a triangle of height h at
// the distance d about (4 d / h)^2, all of it at most; by face. Nothing changes.
#pragma once

#include <span>

#include "quality/joined_triangles.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Figures of the triangles that tell what is lost.
struct LossFigures {
    std::span<const double> area, distance;
    std::span<const double> bend;  // twice the largest curvature of a quadratic triangle's sides: a
                                   // surface at a distance has so much more area; empty: straight
};

/// slant: of (d / h)^2, what the area of a triangle may differ by, of its own.
Array<double> explained_areas(const JoinedTriangles& mesh, const LossFigures& figures,
                              double slant);

}  // namespace surfmesh
