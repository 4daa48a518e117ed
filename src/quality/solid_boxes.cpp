#include "quality/solid_boxes.hpp"

#include <algorithm>
#include <limits>

namespace surfmesh {

SolidBoxes solid_boxes(std::span<const Point3> points, std::span<const TriangleCorners> triangles,
                       std::span<const std::array<std::int32_t, 2>> beside, std::size_t solids) {
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    SolidBoxes found{Array<Point3>(solids, {INFINITE, INFINITE, INFINITE}),
                     Array<Point3>(solids, {-INFINITE, -INFINITE, -INFINITE})};
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (const std::int32_t solid : beside[t]) {
            if (solid < 0) continue;
            Point3 &low = found.low[solid], &high = found.high[solid];
            for (const Vertex v : {triangles[t].a, triangles[t].b, triangles[t].c}) {
                const Point3 p = points[v];
                low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
            }
        }
    return found;
}

}  // namespace surfmesh
