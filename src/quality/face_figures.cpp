#include "quality/face_figures.hpp"

#include <cmath>
#include <limits>

namespace surfmesh {

FaceShapes face_shapes(std::span<const std::int32_t> faces, std::span<const double> area,
                       std::span<const double> alpha, std::size_t count) {
    FaceShapes found{Array<std::int64_t>(count, 0), Array<double>(count, 0.0),
                     Array<double>(count, 0.0),
                     Array<double>(count, std::numeric_limits<double>::infinity())};
    for (std::size_t t = 0; t < faces.size(); ++t) {
        const std::int32_t face = faces[t];
        ++found.triangles[face];
        found.area[face] += area[t];
        found.alpha_sum[face] += alpha[t];
        if (alpha[t] < found.alpha_min[face]) found.alpha_min[face] = alpha[t];
    }
    return found;
}

FaceDistances face_distances(std::span<const std::int32_t> faces, std::span<const double> distance,
                             std::span<const double> mean_square, std::span<const double> area,
                             std::span<const std::uint8_t> marked, std::size_t count) {
    FaceDistances found{Array<double>(count, 0.0), Array<std::int32_t>(count, 0),
                        Array<double>(count, 0.0), Array<std::int64_t>(count, 0)};
    Array<std::uint8_t> is_known(count, 0);  // has the face had a triangle?
    for (std::size_t t = 0; t < faces.size(); ++t) {
        const std::int32_t face = faces[t];
        const double d = distance[t];
        if (std::isnan(d) || d > found.largest[face] || is_known[face] == 0) {
            is_known[face] = 1;
            found.largest[face] = d;
            found.worst[face] = std::isnan(d) ? 0 : static_cast<std::int32_t>(t);
        }
        found.square[face] += area[t] * mean_square[t];
        found.marked[face] += marked[t] != 0 ? 1 : 0;
    }
    return found;
}

}  // namespace surfmesh
