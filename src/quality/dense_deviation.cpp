#include "quality/dense_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "quality/by_face.hpp"
#include "surfaces/closest_point.hpp"
#include "surfaces/elementary_surfaces.hpp"

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

constexpr double ON_CYLINDER = 1e-9;  // of a triangle's size: so near to r(u, v) are its corners
// radians around the axis from corner to corner, at most: holes of four sides are in. Below pi the
// nearest point lies between the corners
constexpr double TURN = 1.6;

/// A cylinder, as far as distances go.
struct Cylinder {
    Frame frame;
    double radius;

    [[nodiscard]] double distance(Point3 point) const {
        const Point3 from = point - frame.origin;
        return std::abs(norm(Point2{dot(from, frame.x), dot(from, frame.y)}) - radius);
    }
};

std::optional<Cylinder> cylinder_of(const Surface& surface) {
    const auto* turned = dynamic_cast<const TurnedProfile*>(&surface);
    if (turned == nullptr) return {};
    const Profile& profile = turned->profile();
    if (profile.is_circle || profile.outwards != 0.0 || !(profile.radius > 0.0)) return {};
    return Cylinder{turned->frame(), profile.radius};
}

/// The triangles of one face at the same places each.
class FaceLook {
  public:
    FaceLook(const MeasuredMesh& mesh, std::span<const std::int32_t> triangles,
             std::span<const Weights> weights, SurfaceReader& surface, DenseDeviation& found)
        : mesh_(mesh), triangles_(triangles), weights_(weights), surface_(surface), found_(found) {}

    /// By a search for the nearest point from each.
    void search(std::span<const std::int32_t> members, double limit, int steps) {
        for (std::size_t k = 0; k < members.size(); k += TRIANGLES_TOGETHER) {
            const auto block = members.subspan(k, std::min(TRIANGLES_TOGETHER, members.size() - k));
            some_.clear();
            for (const std::int32_t i : block) some_.add(mesh_, triangles_[i], weights_);
            const ClosestPoints near = some_.nearest(surface_, limit, steps);
            for (std::size_t j = 0; j < block.size(); ++j)
                found_.largest[block[j]] =
                    largest_of({near.distance.data() + j * weights_.size(), weights_.size()});
            for (std::size_t i = 0; i < near.distance.size(); ++i)
                if (near.distance[i] > found_.farthest.distance)
                    found_.farthest = {triangles_[block[some_.row[i]]], some_.points[i], near.uv[i],
                                       near.distance[i]};
        }
    }

    /// Those with their corners on a cylinder: the parameters of the nearest point lie between those
    /// of the corners, so that it is the nearest of all. Returns the others.
    Array<std::int32_t> measure_on(const Cylinder& cylinder, std::span<const std::int32_t> members,
                                   int steps) {
        const Array<std::uint8_t> on = are_on_surface(members);
        Array<std::int32_t> others;
        FarPlace farthest = found_.farthest;
        for (std::size_t j = 0; j < members.size(); ++j) {
            const std::int32_t i = members[j], t = triangles_[i];
            if (on[j] == 0) {
                others.push_back(i);
                continue;
            }
            for (const Weights& w : weights_) {
                const Point3 point = place_in(mesh_.points, mesh_.triangles[t], w);
                const double distance = cylinder.distance(point);
                found_.largest[i] = std::max(found_.largest[i], distance);
                if (distance > farthest.distance)
                    farthest = {t, point, place_in(mesh_.uv, mesh_.uv_triangles[t], w), distance};
            }
        }
        if (farthest.distance > found_.farthest.distance) {
            farthest.uv =
                closest_points(surface_, {&farthest.point, 1}, {&farthest.uv, 1}, steps).uv[0];
            found_.farthest = farthest;
        }
        return others;
    }

  private:
    /// Are the corners r(u, v), and near to each other around the axis?
    Array<std::uint8_t> are_on_surface(std::span<const std::int32_t> members) {
        Array<Point2> uv;
        for (const std::int32_t i : members) {
            const TriangleCorners& q = mesh_.uv_triangles[triangles_[i]];
            for (const Vertex v : {q.a, q.b, q.c}) uv.push_back(mesh_.uv[v]);
        }
        surface_.read({uv.data(), uv.size()}, 0);
        Array<std::uint8_t> found(members.size());
        for (std::size_t j = 0; j < members.size(); ++j) {
            const TriangleCorners& k = mesh_.triangles[triangles_[members[j]]];
            const Point3 &a = mesh_.points[k.a], &b = mesh_.points[k.b], &c = mesh_.points[k.c];
            const double most = ON_CYLINDER * ON_CYLINDER * (0.5 * norm(cross(b - a, c - a)));
            const auto is_on = [&](std::size_t corner, Point3 point) {
                const Point3 gap = point - surface_[0][3 * j + corner];
                return dot(gap, gap) <= most;
            };
            const auto [low, high] = std::minmax({uv[3 * j].x, uv[3 * j + 1].x, uv[3 * j + 2].x});
            found[j] = is_on(0, a) && is_on(1, b) && is_on(2, c) && high - low < TURN ? 1 : 0;
        }
        return found;
    }

    const MeasuredMesh& mesh_;
    std::span<const std::int32_t> triangles_;
    std::span<const Weights> weights_;
    SurfaceReader& surface_;
    DenseDeviation& found_;
    DensePoints some_;
};

}  // namespace

DenseDeviation dense_deviation(const MeasuredMesh& mesh, std::span<const std::int32_t> triangles,
                               std::span<const Weights> weights, double limit, int steps) {
    DenseDeviation found;
    found.largest.resize(triangles.size(), 0.0);
    if (weights.empty()) return found;
    const ByFace sorted = by_face(triangles.size(), mesh.surfaces.size(),
                                  [&](std::size_t i) { return mesh.faces[triangles[i]]; });
    for (std::size_t face = 0; face < mesh.surfaces.size(); ++face) {
        if (sorted.of(face).empty()) continue;
        SurfaceReader surface(*mesh.surfaces[face]);
        FaceLook look(mesh, triangles, weights, surface, found);
        if (const std::optional<Cylinder> cylinder = cylinder_of(*mesh.surfaces[face])) {
            const Array<std::int32_t> others = look.measure_on(*cylinder, sorted.of(face), steps);
            look.search({others.data(), others.size()}, limit, steps);
        } else {
            look.search(sorted.of(face), limit, steps);
        }
        if (!surface.failed()) continue;
        found.failed = static_cast<std::int32_t>(face);
        return found;
    }
    return found;
}

}  // namespace surfmesh
