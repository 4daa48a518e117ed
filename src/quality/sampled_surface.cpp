#include "quality/sampled_surface.hpp"

#include <algorithm>
#include <utility>

#include "quality/by_face.hpp"
#include "quality/surface_points.hpp"
#include "space/triangle_distance.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t SAMPLED_AT_ONCE = 512;

/// Of a triangle at barycentric weights.
Point2 place_of(const std::array<Point2, 3>& corners, const Weights& w) {
    const auto& [a, b, c] = corners;
    return {w.a * a.x + w.b * b.x + w.c * c.x, w.a * a.y + w.b * b.y + w.c * c.y};
}

std::array<Point2, 3> corners_of(const MeasuredMesh& mesh, std::int32_t t) {
    const TriangleCorners& q = mesh.uv_triangles[t];
    return {mesh.uv[q.a], mesh.uv[q.b], mesh.uv[q.c]};
}

}  // namespace

SampledSurface sampled_surface(const MeasuredMesh& mesh, std::span<const std::int32_t> triangle,
                               std::span<const std::int32_t> rule,
                               std::span<const Weights> weights) {
    SampledSurface found;
    Array<std::int32_t> faces(triangle.size());
    found.uv.resize(triangle.size());
    for (std::size_t i = 0; i < triangle.size(); ++i) {
        found.uv[i] = place_of(corners_of(mesh, triangle[i]), weights[rule[i]]);
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

SurfaceDistances surface_distances(const MeasuredMesh& mesh,
                                   std::span<const std::int32_t> triangles,
                                   std::span<const Weights> weights) {
    SurfaceDistances found;
    const std::size_t each = weights.size();
    found.distance.resize(each * triangles.size());
    const ByFace sorted = by_face(triangles.size(), mesh.surfaces.size(),
                                  [&](std::size_t row) { return mesh.faces[triangles[row]]; });
    Array<Point2> places;
    SurfaceValues values;
    for (std::size_t face = 0; face < mesh.surfaces.size(); ++face) {
        const auto members = sorted.of(face);
        for (std::size_t k = 0; k < members.size(); k += SAMPLED_AT_ONCE) {
            const auto some = members.subspan(k, std::min(SAMPLED_AT_ONCE, members.size() - k));
            places.clear();
            for (const std::int32_t row : some)
                for (const Weights& w : weights)
                    places.push_back(place_of(corners_of(mesh, triangles[row]), w));
            if (values.evaluate(*mesh.surfaces[face], {places.data(), places.size()}, 0) !=
                SurfaceStatus::DONE) {
                found.failed = static_cast<std::int32_t>(face);
                return found;
            }
            for (std::size_t i = 0; i < some.size(); ++i) {
                const TriangleCorners& t = mesh.triangles[triangles[some[i]]];
                const DistanceToTriangle distance(
                    {mesh.points[t.a], mesh.points[t.b], mesh.points[t.c]});
                for (std::size_t j = 0; j < each; ++j)
                    found.distance[each * some[i] + j] = distance.of(values[0][each * i + j]);
            }
        }
    }
    return found;
}

}  // namespace surfmesh
