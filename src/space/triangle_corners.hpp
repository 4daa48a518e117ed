// A triangle of a mesh as the numbers of its vertices.
#pragma once

#include <span>

#include "values/conventions.hpp"

namespace surfmesh {

struct TriangleCorners {
    Vertex a, b, c;
};
static_assert(sizeof(TriangleCorners) == 3 * sizeof(Vertex));

/// The corners of triangles one after the other: number e is where half-edge e starts.
inline std::span<const Vertex> corners_in_a_row(std::span<const TriangleCorners> triangles) {
    return {reinterpret_cast<const Vertex*>(triangles.data()), 3 * triangles.size()};
}

}  // namespace surfmesh
