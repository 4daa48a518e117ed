// Triangles of many faces in one row, their corners numbered on from face to face.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"

namespace surfmesh {

struct TrianglesOfFace {
    std::span<const std::int32_t> corners;  // three of each triangle, from 0 on
    std::int64_t points;                    // how many the face has
    bool is_turned;                         // its triangles are to be turned over
};

/// Three corners of each triangle; a turned one begins where it did. names: of the points of all
/// faces in one row, what a corner there is called; none: by its place in that row.
[[nodiscard]] Array<std::int32_t> triangles_in_a_row(std::span<const TrianglesOfFace> faces,
                                                     std::span<const std::int32_t> names);

/// Of the points of all faces in one row: is there a triangle with a corner there?
[[nodiscard]] Array<std::uint8_t> are_corners(std::span<const TrianglesOfFace> faces);

}  // namespace surfmesh
