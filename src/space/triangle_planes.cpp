#include "space/triangle_planes.hpp"

#include <algorithm>

namespace surfmesh {

TrianglePlanes triangle_planes(std::span<const Point3> points,
                               std::span<const TriangleCorners> triangles,
                               std::span<const std::int32_t> chosen) {
    TrianglePlanes found{Array<Point3>(chosen.size()), Array<double>(chosen.size()),
                         Array<double>(chosen.size())};
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const TriangleCorners& t = triangles[chosen[k]];
        const Point3 a = points[t.a], b = points[t.b], c = points[t.c];
        const Point3 n = cross(b - a, c - a);
        const double length = norm(n);
        if (length > 0.0) found.normal[k] = {n.x / length, n.y / length, n.z / length};
        found.twice_area[k] = length;
        found.longest[k] = std::max({norm(a - b), norm(b - c), norm(c - a)});
    }
    return found;
}

}  // namespace surfmesh
