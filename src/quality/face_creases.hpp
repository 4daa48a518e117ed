// Edges within faces across which the surface bends by itself: creases and apexes (patch/creases).
//
// In: a mesh on its surfaces, pairs of half-edges of one face each, and the angle asked for of each
// face. Out: which of the edges do, face by face with the diagonal of the box of the face's
// triangles; a surface that fails is named.
#pragma once

#include <cstdint>
#include <span>

#include "optimisation/dihedral.hpp"
#include "quality/measured_mesh.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct FaceCreases {
    Array<std::uint8_t> bent;  // of each edge, 0 or 1
    std::int32_t failed = -1;  // number of a face, then nothing else counts
};

/// angle: degrees, of each face.
FaceCreases face_creases(const MeasuredMesh& mesh, std::span<const HalfEdgePair> edges,
                         std::span<const double> angle);

}  // namespace surfmesh
