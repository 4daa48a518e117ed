#include "quality/plane_triangles.hpp"

#include <vector>

namespace surfmesh {
namespace {

constexpr double ON_PLANE = 1e-9;  // of a triangle's size: so near to r(u, v) are its corners

double squared_gap(const Frame& plane, Point3 point, Point2 uv) {
    const Point3 gap = point - (plane.origin + uv.x * plane.x + uv.y * plane.y);
    return dot(gap, gap);
}

/// Twice the area.
double doubled_area(Point3 a, Point3 b, Point3 c) { return norm(cross(b - a, c - a)); }

}  // namespace

const Frame* plane_of(const Surface& surface) {
    const auto* plane = dynamic_cast<const Plane*>(&surface);
    return plane == nullptr ? nullptr : &plane->frame();
}

Array<std::uint8_t> plane_triangles(const MeasuredMesh& mesh) {
    std::vector<const Frame*> planes;
    planes.reserve(mesh.surfaces.size());
    for (const Surface* surface : mesh.surfaces) planes.push_back(plane_of(*surface));
    Array<std::uint8_t> found(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < found.size(); ++t) {
        const Frame* plane = planes[mesh.faces[t]];
        if (plane == nullptr) continue;
        const TriangleCorners &k = mesh.triangles[t], &q = mesh.uv_triangles[t];
        const Point3 &a = mesh.points[k.a], &b = mesh.points[k.b], &c = mesh.points[k.c];
        const double most = ON_PLANE * ON_PLANE * (0.5 * doubled_area(a, b, c));
        found[t] = squared_gap(*plane, a, mesh.uv[q.a]) <= most &&
                           squared_gap(*plane, b, mesh.uv[q.b]) <= most &&
                           squared_gap(*plane, c, mesh.uv[q.c]) <= most
                       ? 1
                       : 0;
    }
    return found;
}

}  // namespace surfmesh
