#include "quality/surface_points.hpp"

#include "quality/by_face.hpp"

namespace surfmesh {

SurfacePoints surface_points(std::span<const Surface* const> surfaces,
                             std::span<const std::int32_t> faces, std::span<const Point2> uv,
                             int order) {
    SurfacePoints found;
    const std::size_t count = derivative_count(order);
    for (std::size_t k = 0; k < count; ++k) found.values.emplace_back(uv.size());
    const ByFace sorted =
        by_face(uv.size(), surfaces.size(), [&](std::size_t i) { return faces[i]; });
    Array<Point2> places;
    SurfaceValues values;
    for (std::size_t face = 0; face < surfaces.size(); ++face) {
        const auto members = sorted.of(face);
        if (members.empty()) continue;
        places.clear();
        for (const std::int32_t i : members) places.push_back(uv[i]);
        if (values.evaluate(*surfaces[face], {places.data(), places.size()}, order) !=
            SurfaceStatus::DONE) {
            found.failed = static_cast<std::int32_t>(face);
            return found;
        }
        for (std::size_t k = 0; k < count; ++k)
            for (std::size_t j = 0; j < members.size(); ++j)
                found.values[k][members[j]] = values[k][j];
    }
    return found;
}

}  // namespace surfmesh
