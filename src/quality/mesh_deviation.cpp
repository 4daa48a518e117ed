#include "quality/mesh_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "patch/deviation.hpp"
#include "patch/samples.hpp"
#include "quality/by_face.hpp"
#include "quality/plane_triangles.hpp"
#include "values/conventions.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t BLOCK = 1024;  // places looked at together
constexpr double VERTEX_WEIGHT = 1.0 / 20.0, MIDDLE_WEIGHT = 2.0 / 15.0,
                 CENTROID_WEIGHT = 9.0 / 20.0;

/// Places that are looked at together, with their memory, which is used again.
struct Places {
    Array<Point3> points;
    Array<Point2> uv;
    Array<double> size;

    void clear() {
        points.clear();
        uv.clear();
        size.clear();
    }
    /// A place of triangle t at barycentric weights.
    void add(const MeasuredMesh& mesh, std::size_t t, const BarycentricWeights& w, double area) {
        const TriangleCorners &k = mesh.triangles[t], &q = mesh.uv_triangles[t];
        points.push_back(
            at_weights<Point3>({mesh.points[k.a], mesh.points[k.b], mesh.points[k.c]}, w));
        uv.push_back(at_weights<Point2>({mesh.uv[q.a], mesh.uv[q.b], mesh.uv[q.c]}, w));
        size.push_back(std::sqrt(area));
    }
    template <class T>
    static std::span<const T> all(const Array<T>& values) {
        return {values.data(), values.size()};
    }
};

/// The larger of two, NaN where one of them is.
double larger(double a, double b) { return b > a || b != b ? b : a; }

Vertex corner(const TriangleCorners& t, std::size_t k) { return k == 0 ? t.a : k == 1 ? t.b : t.c; }

/// Call work(some members) block after block.
template <class Work>
void in_blocks(std::span<const std::int32_t> members, const Work& work) {
    for (std::size_t k = 0; k < members.size(); k += BLOCK)
        work(members.subspan(k, std::min(BLOCK, members.size() - k)));
}

/// Of points above a plane.
class HeightAbove {
  public:
    explicit HeightAbove(const Frame& plane)
        : origin_(plane.origin), normal_(cross(plane.x, plane.y)) {}

    [[nodiscard]] Point3 normal() const { return normal_; }
    double operator()(Point3 point) const { return dot(point - origin_, normal_); }

  private:
    Point3 origin_, normal_;
};

class Measure {
  public:
    Measure(const MeasuredMesh& mesh, std::span<const EdgeSides> edges,
            std::span<const double> area, std::span<const std::uint8_t> in_plane)
        : mesh_(mesh),
          edges_(edges),
          area_(area),
          in_plane_(in_plane),
          at_vertex_(mesh.points.size(), 0.0) {
        found_.largest.resize(mesh.triangles.size(), 0.0);
        found_.mean_square.resize(mesh.triangles.size(), 0.0);
        found_.cosine.resize(mesh.triangles.size(), 1.0F);
    }

    MeshDeviation run() {
        const std::size_t faces = mesh_.surfaces.size();
        const ByFace triangles =
            by_face(mesh_.triangles.size(), faces, [&](std::size_t t) { return mesh_.faces[t]; });
        const ByFace middles = by_face(edges_.size(), faces, [&](std::size_t e) {
            return mesh_.faces[edges_[e].half_edge / 3];
        });
        const Array<std::int32_t> corners = corners_of_vertices();
        const ByFace vertices = by_face(corners.size(), faces,
                                        [&](std::size_t k) { return mesh_.faces[corners[k] / 3]; });
        for (std::size_t face = 0; face < faces; ++face) {
            SurfaceReader surface(*mesh_.surfaces[face]);
            at_vertices(surface, corners, vertices.of(face));
            if (const Frame* plane = plane_of(*mesh_.surfaces[face])) {
                const HeightAbove height(*plane);
                at_middles(surface, middles_in_plane(height, middles.of(face)));
                at_centroids(surface, centroids_in_plane(height, triangles.of(face)));
            } else {
                at_middles(surface, middles.of(face));
                at_centroids(surface, triangles.of(face));
            }
            if (!surface.failed()) continue;
            found_.failed = static_cast<std::int32_t>(face);
            return std::move(found_);
        }
        add_vertices();
        return std::move(found_);
    }

  private:
    /// One corner of each vertex that has a triangle: the last.
    Array<std::int32_t> corners_of_vertices() const {
        Array<std::int32_t> corner_of(mesh_.points.size(), NIL);
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                corner_of[corner(mesh_.triangles[t], k)] = static_cast<std::int32_t>(3 * t + k);
        Array<std::int32_t> corners;
        corners.reserve(corner_of.size());
        for (const std::int32_t c : corner_of)
            if (c != NIL) corners.push_back(c);
        return corners;
    }

    void at_vertices(SurfaceReader& surface, const Array<std::int32_t>& corners,
                     std::span<const std::int32_t> members) {
        in_blocks(members, [&](std::span<const std::int32_t> some) {
            places_.clear();
            for (const std::int32_t i : some) {
                const std::size_t t = corners[i] / 3, k = corners[i] % 3;
                places_.points.push_back(mesh_.points[corner(mesh_.triangles[t], k)]);
                places_.uv.push_back(mesh_.uv[corner(mesh_.uv_triangles[t], k)]);
                places_.size.push_back(std::sqrt(area_[t]));
            }
            const Array<double> distance =
                vertex_deviations(surface, Places::all(places_.points), Places::all(places_.uv),
                                  Places::all(places_.size));
            for (std::size_t j = 0; j < some.size(); ++j) {
                const std::int32_t c = corners[some[j]];
                at_vertex_[corner(mesh_.triangles[c / 3], c % 3)] = distance[j];
            }
        });
    }

    void at_middles(SurfaceReader& surface, std::span<const std::int32_t> members) {
        in_blocks(members, [&](std::span<const std::int32_t> some) {
            places_.clear();
            for (const std::int32_t e : some) {
                const std::size_t t = edges_[e].half_edge / 3, side = edges_[e].half_edge % 3;
                places_.add(mesh_, t, FEW_SAMPLES[side], area_[t]);
            }
            const PointDeviations found = measured(surface);
            for (std::size_t j = 0; j < some.size(); ++j)
                add_at_middle(edges_[some[j]], found.distance[j]);
        });
    }

    void at_centroids(SurfaceReader& surface, std::span<const std::int32_t> members) {
        in_blocks(members, [&](std::span<const std::int32_t> some) {
            places_.clear();
            for (const std::int32_t t : some) places_.add(mesh_, t, CENTROID, area_[t]);
            const PointDeviations found = measured(surface);
            for (std::size_t j = 0; j < some.size(); ++j) {
                add(some[j], found.distance[j], CENTROID_WEIGHT);
                found_.cosine[some[j]] = static_cast<float>(cosine(some[j], found.normal[j]));
            }
        });
    }

    /// What triangles in a plane say of the middles of their edges. Returns the other edges.
    std::span<const std::int32_t> middles_in_plane(const HeightAbove& height,
                                                   std::span<const std::int32_t> members) {
        others_.clear();
        for (const std::int32_t e : members) {
            const std::size_t t = edges_[e].half_edge / 3, side = edges_[e].half_edge % 3;
            if (in_plane_[t] == 0) {
                others_.push_back(e);
                continue;
            }
            const TriangleCorners& corners = mesh_.triangles[t];
            const double sum = height(mesh_.points[corner(corners, side)]) +
                               height(mesh_.points[corner(corners, (side + 1) % 3)]);
            add_at_middle(edges_[e], 0.5 * std::abs(sum));
        }
        return Places::all(others_);
    }

    /// The same of their centroids. Returns the other triangles.
    std::span<const std::int32_t> centroids_in_plane(const HeightAbove& height,
                                                     std::span<const std::int32_t> members) {
        others_.clear();
        for (const std::int32_t t : members) {
            if (in_plane_[t] == 0) {
                others_.push_back(t);
                continue;
            }
            const TriangleCorners& k = mesh_.triangles[t];
            const double sum =
                height(mesh_.points[k.a]) + height(mesh_.points[k.b]) + height(mesh_.points[k.c]);
            add(t, std::abs(sum) / 3.0, CENTROID_WEIGHT);
            found_.cosine[t] = static_cast<float>(cosine(t, height.normal()));
        }
        return Places::all(others_);
    }

    void add_at_middle(const EdgeSides& sides, double distance) {
        add(sides.half_edge / 3, distance, MIDDLE_WEIGHT);
        if (sides.twin != NIL) add(sides.twin / 3, distance, MIDDLE_WEIGHT);
    }

    PointDeviations measured(SurfaceReader& surface) const {
        return point_deviations(surface, Places::all(places_.points), Places::all(places_.uv),
                                Places::all(places_.size));
    }

    void add(std::int32_t triangle, double distance, double weight) {
        found_.mean_square[triangle] += weight * (distance * distance);
        found_.largest[triangle] = larger(found_.largest[triangle], distance);
    }

    [[nodiscard]] double cosine(std::int32_t triangle, Point3 normal) const {
        if (normal.x == 0.0 && normal.y == 0.0 && normal.z == 0.0) return 1.0;
        const TriangleCorners& t = mesh_.triangles[triangle];
        const double length = 2.0 * area_[triangle];
        if (length == 0.0) return 1.0;
        const Point3 own =
            cross(mesh_.points[t.b] - mesh_.points[t.a], mesh_.points[t.c] - mesh_.points[t.a]);
        return length > 0.0 ? dot(own, normal) / length : std::numeric_limits<double>::quiet_NaN();
    }

    void add_vertices() {
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            double square = 0.0;
            for (std::size_t k = 0; k < 3; ++k) {
                const double distance = at_vertex_[corner(mesh_.triangles[t], k)];
                square += distance * distance;
                found_.largest[t] = larger(found_.largest[t], distance);
            }
            found_.mean_square[t] += VERTEX_WEIGHT * square;
        }
    }

    const MeasuredMesh& mesh_;
    std::span<const EdgeSides> edges_;
    std::span<const double> area_;
    std::span<const std::uint8_t> in_plane_;
    Array<double> at_vertex_;
    Array<std::int32_t> others_;  // of a plane: what is looked at as on any surface
    MeshDeviation found_;
    Places places_;
};

}  // namespace

MeshDeviation mesh_deviation(const MeasuredMesh& mesh, std::span<const EdgeSides> edges,
                             std::span<const double> area, std::span<const std::uint8_t> in_plane) {
    return Measure(mesh, edges, area, in_plane).run();
}

}  // namespace surfmesh
