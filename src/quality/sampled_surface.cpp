#include "quality/sampled_surface.hpp"

#include <utility>

#include "quality/surface_points.hpp"
#include "space/triangle_distance.hpp"

namespace surfmesh {

SampledSurface sampled_surface(const MeasuredMesh& mesh, std::span<const std::int32_t> triangle,
                               std::span<const std::int32_t> rule,
                               std::span<const Weights> weights) {
    SampledSurface found;
    Array<std::int32_t> faces(triangle.size());
    found.uv.resize(triangle.size());
    for (std::size_t i = 0; i < triangle.size(); ++i) {
        const TriangleCorners& q = mesh.uv_triangles[triangle[i]];
        const Weights& w = weights[rule[i]];
        const Point2 &a = mesh.uv[q.a], &b = mesh.uv[q.b], &c = mesh.uv[q.c];
        found.uv[i] = {w.a * a.x + w.b * b.x + w.c * c.x, w.a * a.y + w.b * b.y + w.c * c.y};
        faces[i] = mesh.faces[triangle[i]];
    }
    SurfacePoints there = surface_points(mesh.surfaces, {faces.data(), faces.size()},
                                         {found.uv.data(), found.uv.size()}, 0);
    found.failed = there.failed;
    if (found.failed >= 0) return found;
    found.points = std::move(there.values[0]);
    found.distance.resize(triangle.size());
    for (std::size_t i = 0; i < triangle.size(); ++i) {
        const TriangleCorners& t = mesh.triangles[triangle[i]];
        found.distance[i] = triangle_distance(
            found.points[i], {mesh.points[t.a], mesh.points[t.b], mesh.points[t.c]});
    }
    return found;
}

}  // namespace surfmesh
