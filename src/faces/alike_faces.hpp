// Faces in classes of alike ones: of a bolt circle the holes are one class.
//
//     loops -> segments, length, sum of sizes, rounded --+
//     area, rounded                                      +-- the same -> one class
//     sort: what must not differ otherwise --------------+
#pragma once

#include <vector>

#include "faces/face_boundary.hpp"

namespace surfmesh {

/// Rows of many faces.
struct AlikeFaces {
    Array<double> fewest;          // triangles within the loops when no node lies inside
    Array<double> size;            // mean of the sizes at the nodes; infinite where there are none
    Array<std::int64_t> class_of;  // their classes, from 0 on as they come
    Array<std::int64_t> first_of;  // of the classes: the first face
};

/// Triangles within the loops when no node lies inside, by Euler's formula.
[[nodiscard]] double fewest_triangles(const FaceBoundary& boundary);

/// In: boundaries, areas and sorts of the faces; those of different sorts are not alike.
[[nodiscard]] AlikeFaces alike_faces(const std::vector<const FaceBoundary*>& boundaries,
                                     std::span<const double> areas,
                                     std::span<const std::int64_t> sorts);

}  // namespace surfmesh
