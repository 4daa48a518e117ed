#include "quality/dense_deviation.hpp"

#include <algorithm>

#include "quality/by_face.hpp"
#include "surfaces/closest_point.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t TRIANGLES_TOGETHER = 64;

template <class Point>
Point place_in(std::span<const Point> values, const TriangleCorners& t, const Weights& w) {
    return w.a * values[t.a] + w.b * values[t.b] + w.c * values[t.c];
}

/// The points of a few triangles, with their memory, which is used again.
struct DensePoints {
    Array<Point3> points;
    Array<Point2> uv;
    Array<ParameterTriangle> corners;
    Array<std::int64_t> row;  // of the triangle among the few

    void clear() {
        points.clear();
        uv.clear();
        corners.clear();
        row.clear();
    }
    void add(const MeasuredMesh& mesh, std::int32_t t, std::span<const Weights> weights) {
        const TriangleCorners &k = mesh.triangles[t], &q = mesh.uv_triangles[t];
        for (const Weights& w : weights) {
            points.push_back(place_in(mesh.points, k, w));
            uv.push_back(place_in(mesh.uv, q, w));
            row.push_back(static_cast<std::int64_t>(corners.size()));
        }
        corners.push_back({mesh.uv[q.a], mesh.uv[q.b], mesh.uv[q.c]});
    }
    [[nodiscard]] ClosestPoints nearest(SurfaceReader& surface, double limit, int steps) const {
        return closest_points_in_triangles(surface, {points.data(), points.size()},
                                           {uv.data(), uv.size()}, {corners.data(), corners.size()},
                                           {row.data(), row.size()}, limit, steps);
    }
};

/// The largest of some distances, NaN where one of them is.
double largest_of(std::span<const double> distances) {
    double largest = distances[0];
    for (const double d : distances)
        if (d > largest || d != d) largest = d;
    return largest;
}

}  // namespace

DenseDeviation dense_deviation(const MeasuredMesh& mesh, std::span<const std::int32_t> triangles,
                               std::span<const Weights> weights, double limit, int steps) {
    DenseDeviation found;
    found.largest.resize(triangles.size(), 0.0);
    if (weights.empty()) return found;
    const ByFace sorted = by_face(triangles.size(), mesh.surfaces.size(),
                                  [&](std::size_t i) { return mesh.faces[triangles[i]]; });
    DensePoints some;
    for (std::size_t face = 0; face < mesh.surfaces.size(); ++face) {
        SurfaceReader surface(*mesh.surfaces[face]);
        const std::span<const std::int32_t> members = sorted.of(face);
        for (std::size_t k = 0; k < members.size(); k += TRIANGLES_TOGETHER) {
            const auto block = members.subspan(k, std::min(TRIANGLES_TOGETHER, members.size() - k));
            some.clear();
            for (const std::int32_t i : block) some.add(mesh, triangles[i], weights);
            const ClosestPoints near = some.nearest(surface, limit, steps);
            for (std::size_t j = 0; j < block.size(); ++j)
                found.largest[block[j]] =
                    largest_of({near.distance.data() + j * weights.size(), weights.size()});
            for (std::size_t i = 0; i < near.distance.size(); ++i)
                if (near.distance[i] > found.farthest.distance)
                    found.farthest = {triangles[block[some.row[i]]], some.points[i], near.uv[i],
                                      near.distance[i]};
        }
        if (!surface.failed()) continue;
        found.failed = static_cast<std::int32_t>(face);
        return found;
    }
    return found;
}

}  // namespace surfmesh
