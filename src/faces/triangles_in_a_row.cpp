#include "faces/triangles_in_a_row.hpp"

namespace surfmesh {

Array<std::int64_t> triangles_in_a_row(std::span<const TrianglesOfFace> faces) {
    std::size_t total = 0;
    for (const TrianglesOfFace& face : faces) total += face.corners.size();
    Array<std::int64_t> row(total);
    std::int64_t* at = row.data();
    std::int64_t first = 0;
    for (const auto& [corners, points, is_turned] : faces) {
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3, at += 3) {
            at[0] = first + corners[i];
            at[1] = first + corners[i + (is_turned ? 2 : 1)];
            at[2] = first + corners[i + (is_turned ? 1 : 2)];
        }
        first += points;
    }
    return row;
}

}  // namespace surfmesh
