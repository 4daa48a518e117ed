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

/// Three corners of each triangle; a turned one begins where it did.
[[nodiscard]] Array<std::int64_t> triangles_in_a_row(std::span<const TrianglesOfFace> faces);

}  // namespace surfmesh
