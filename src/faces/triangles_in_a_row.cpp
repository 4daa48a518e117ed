#include "faces/triangles_in_a_row.hpp"

#include <algorithm>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t FACES_TOGETHER = 16;
constexpr std::size_t FEW_CORNERS = 100'000;  // are put in a row before another thread has begun

/// Where the corners and the points of each face begin, and how many there are in all.
struct RowsOfFaces {
    Array<std::size_t> corner, point;

    explicit RowsOfFaces(std::span<const TrianglesOfFace> faces) : corner(1, 0), point(1, 0) {
        for (const TrianglesOfFace& face : faces) {
            corner.push_back(corner.back() + face.corners.size());
            point.push_back(point.back() + static_cast<std::size_t>(face.points));
        }
    }

    /// Call work(face, first corner, first point) for all of them.
    template <class Work>
    void for_each_face(const Work& work) {
        const std::size_t count = corner.size() - 1;
        const std::size_t block = corner.back() < FEW_CORNERS ? count : FACES_TOGETHER;
        for_each_block(count, std::max<std::size_t>(block, 1), [&](std::size_t k, std::size_t end) {
            for (; k < end; ++k) work(k, corner.data()[k], point.data()[k]);
        });
    }
};

}  // namespace

Array<std::int32_t> triangles_in_a_row(std::span<const TrianglesOfFace> faces,
                                       std::span<const std::int32_t> names) {
    RowsOfFaces rows(faces);
    Array<std::int32_t> row(rows.corner.back());
    rows.for_each_face([&](std::size_t k, std::size_t corner, std::size_t point) {
        const auto& [corners, points, is_turned] = faces[k];
        const auto name = [&](std::size_t i) {
            const std::size_t place = point + static_cast<std::size_t>(corners[i]);
            return names.empty() ? static_cast<std::int32_t>(place) : names[place];
        };
        std::int32_t* at = row.data() + corner;
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3, at += 3) {
            at[0] = name(i);
            at[1] = name(i + (is_turned ? 2 : 1));
            at[2] = name(i + (is_turned ? 1 : 2));
        }
    });
    return row;
}

Array<std::uint8_t> are_corners(std::span<const TrianglesOfFace> faces) {
    RowsOfFaces rows(faces);
    Array<std::uint8_t> found(rows.point.back(), 0);
    rows.for_each_face([&](std::size_t k, std::size_t, std::size_t point) {
        for (const std::int32_t corner : faces[k].corners)
            found.data()[point + static_cast<std::size_t>(corner)] = 1;
    });
    return found;
}

}  // namespace surfmesh
