// Dihedral angles within the faces of a finished mesh, in one pass over the edges.
//
// Few angles are worth an arc tangent: those beyond the limit of their face, and those that may be
// the largest of it. Sines and cosines of both tell the others, with room for rounding.
//
// In: triangles with their edge table, a limit of each face, degrees. Out: the edges beyond, and of
// the other edges within each face the largest angle. Nothing changes.
#pragma once

#include <cstdint>
#include <span>

#include "quality/joined_triangles.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct AnglesWithinFaces {
    Array<std::int64_t> edges;   // between two triangles of one face, beyond its limit, in order
    Array<double> degrees;       // there
    Array<double> largest;       // of each face, degrees, among the others; 0 without any
    Array<std::int64_t> number;  // of edges within each face, all of them
    std::int64_t largest_edge = NIL;  // the first of the others where the largest of all is
};

/// limits: degrees, of each face.
AnglesWithinFaces angles_within_faces(const JoinedTriangles& mesh, std::span<const double> limits);

}  // namespace surfmesh
