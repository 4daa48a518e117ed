// The meshes of many faces joined into one: what neighbours share are the numbers of nodes.
//
//     shared nodes, 0 .. s - 1          those that a triangle has keep their order and come first
//     inner points, face after face     then of these those that a triangle has
//
// In: points and sizes of the shared nodes; of each face its mesh, with the slot of each point in
// its boundary (-1 inside), and the numbers of the nodes there. Out: one row of each kind for the
// whole mesh. By threads, each face by itself; the result does not depend on how many there are.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// A face as it was meshed.
struct FacePart {
    std::span<const Point3> points;
    std::span<const std::int64_t> slots;  // of the points
    std::span<const double> sizes;        // of the points
    std::span<const std::int32_t> triangles;
    std::span<const Point2> uv;
    std::span<const std::int32_t> uv_triangles;
    std::span<const std::int64_t> numbers;  // of the nodes of its boundary
    std::int32_t face;                      // its number
    bool is_turned;                         // its triangles are to be turned over
};

struct SharedNodes {
    std::span<const Point3> points;
    std::span<const double> sizes;
};

struct JoinedFaces {
    Array<std::int64_t> rank;  // of the shared nodes: vertex of the mesh, -1 for none
    Array<Point3> points;
    Array<double> sizes;  // of the points: the least that is known
    Array<std::int32_t> triangles;
    Array<std::int32_t> face_ids;  // of the triangles
    Array<Point2> uv;
    Array<std::int32_t> uv_triangles;
};

/// A turned triangle begins where it did. Slots, corners and numbers have to be in range.
[[nodiscard]] JoinedFaces joined_faces(const SharedNodes& shared, std::span<const FacePart> parts);

}  // namespace surfmesh
