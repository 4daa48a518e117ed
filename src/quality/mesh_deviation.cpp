#include "quality/mesh_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "patch/deviation.hpp"
#include "patch/samples.hpp"
#include "quality/by_face.hpp"
#include "quality/plane_triangles.hpp"
#include "surfaces/closest_point.hpp"
#include "values/conventions.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t BLOCK = 1024;  // places looked at together
constexpr double ASTRAY = 0.05;      // of the size: a foot this far is looked for from corners too
constexpr int PATIENT_STEPS = 60;  // of that search: beside elongated poles many steps lead astray
constexpr double ON_SURFACE = 1e-9;  // of the size: a vertex this near to r(u, v) is on it
constexpr double VERTEX_WEIGHT = 1.0 / 20.0, MIDDLE_WEIGHT = 2.0 / 15.0,
                 CENTROID_WEIGHT = 9.0 / 20.0;

/// Places that are looked at together, with their memory, which is used again.
struct Places {
    Array<Point3> points;
    Array<Point2> uv;
    Array<std::int32_t> triangle;
    Array<double> area, squared;  // of the triangle; distances squared, which are filled in

    void resize(std::size_t count) {
        points.resize(count);
        uv.resize(count);
        triangle.resize(count);
        area.resize(count);
        squared.resize(count);
    }
};

/// Places whose feet are far: where to look again, and how far the feet were, squared.
struct FarPlaces {
    Array<std::int32_t> places;
    Array<Point2> uv;
    Array<double> whole;

    void clear() {
        places.clear();
        uv.clear();
        whole.clear();
    }
    void add(std::int32_t place, Point2 to, double squared) {
        places.push_back(place);
        uv.push_back(to);
        whole.push_back(squared);
    }
};

/// Of a point from a place of the surface, squared: its distance, that along the normal and the one
/// across; all the same where there is no normal.
struct Offset {
    Point3 gap, normal;  // of any length
    double squared;      // of the normal
    double whole, along, across;

    Offset(Point3 point, Point3 foot, Point3 ru, Point3 rv)
        : gap(point - foot),
          normal(cross(ru, rv)),
          squared(dot(normal, normal)),
          whole(dot(gap, gap)),
          along(whole),
          across(whole) {
        if (!(squared > 0.0)) return;
        const double high = dot(gap, normal);
        along = high * high / squared;
        across = whole - along;
    }

    /// In (u, v) to the foot of the point in the tangent plane.
    [[nodiscard]] Point2 step(Point3 ru, Point3 rv) const {
        if (!(squared > 0.0)) return {0.0, 0.0};
        // (d x r_v) . n = du n . n for d = du r_u + dv r_v and n = r_u x r_v, likewise for dv
        return {dot(cross(gap, rv), normal) / squared, dot(cross(ru, gap), normal) / squared};
    }
};

Point2 within(const ParameterBox& box, Point2 p) {
    return {std::min(std::max(p.x, box.low.x), box.high.x),
            std::min(std::max(p.y, box.low.y), box.high.y)};
}

/// The middle of two corners, the centroid of three.
template <class Point>
Point middle(Point a, Point b) {
    return 0.5 * a + 0.5 * b;
}
template <class Point>
Point centroid(Point a, Point b, Point c) {
    return at_weights<Point>({a, b, c}, CENTROID);
}

template <class T>
std::span<const T> all(const Array<T>& values) {
    return {values.data(), values.size()};
}

/// The larger of two, NaN where one of them is.
double larger(double a, double b) { return b > a || b != b ? b : a; }

Vertex corner(const TriangleCorners& t, std::size_t k) { return std::span(&t.a, 3)[k]; }

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

/// Edges whose middles are looked at: within a face once, between two faces from both of them; not
/// from triangles in a plane, whose corners say all.
Array<EdgeSides> edges_of_faces(const MeasuredMesh& mesh, std::span<const EdgeSides> all,
                                std::span<const std::uint8_t> in_plane) {
    const auto is_left_out = [&](HalfEdge side) { return side == NIL || in_plane[side / 3] != 0; };
    Array<EdgeSides> found;
    found.reserve(all.size());
    for (const auto& [first, second] : all) {
        if (second == NIL || mesh.faces[first / 3] == mesh.faces[second / 3]) {
            if (!is_left_out(first) || !is_left_out(second)) found.push_back({first, second});
        } else {
            for (const HalfEdge side : {first, second})
                if (!is_left_out(side)) found.push_back({side, NIL});
        }
    }
    return found;
}

class Measure {
  public:
    Measure(const MeasuredMesh& mesh, std::span<const EdgeSides> edges,
            std::span<const double> area, std::span<const std::uint8_t> in_plane)
        : mesh_(mesh),
          edges_(edges_of_faces(mesh, edges, in_plane)),
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
                in_plane(HeightAbove(*plane), triangles.of(face));
                at_centroids(surface, all(others_));
            } else {
                at_centroids(surface, triangles.of(face));
            }
            at_middles(surface, middles.of(face));
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
            places_.resize(some.size());
            for (std::size_t j = 0; j < some.size(); ++j) {
                const std::size_t t = corners[some[j]] / 3, k = corners[some[j]] % 3;
                places_.points[j] = mesh_.points[corner(mesh_.triangles[t], k)];
                places_.uv[j] = mesh_.uv[corner(mesh_.uv_triangles[t], k)];
                places_.area[j] = area_[t];
            }
            measure_vertices(surface);
            for (std::size_t j = 0; j < some.size(); ++j) {
                const std::int32_t c = corners[some[j]];
                at_vertex_[corner(mesh_.triangles[c / 3], c % 3)] = places_.squared[j];
            }
        });
    }

    void at_middles(SurfaceReader& surface, std::span<const std::int32_t> members) {
        in_blocks(members, [&](std::span<const std::int32_t> some) {
            places_.resize(some.size());
            for (std::size_t j = 0; j < some.size(); ++j) {
                const std::size_t t = edges_[some[j]].half_edge / 3,
                                  side = edges_[some[j]].half_edge % 3, next = (side + 1) % 3;
                const TriangleCorners &k = mesh_.triangles[t], &q = mesh_.uv_triangles[t];
                places_.points[j] =
                    middle(mesh_.points[corner(k, side)], mesh_.points[corner(k, next)]);
                places_.uv[j] = middle(mesh_.uv[corner(q, side)], mesh_.uv[corner(q, next)]);
                places_.triangle[j] = static_cast<std::int32_t>(t);
                places_.area[j] = area_[t];
            }
            measure(surface);
            for (std::size_t j = 0; j < some.size(); ++j)
                add_at_middle(edges_[some[j]], places_.squared[j]);
        });
    }

    void at_centroids(SurfaceReader& surface, std::span<const std::int32_t> members) {
        in_blocks(members, [&](std::span<const std::int32_t> some) {
            places_.resize(some.size());
            for (std::size_t j = 0; j < some.size(); ++j) {
                const TriangleCorners &k = mesh_.triangles[some[j]],
                                      &q = mesh_.uv_triangles[some[j]];
                places_.points[j] =
                    centroid(mesh_.points[k.a], mesh_.points[k.b], mesh_.points[k.c]);
                places_.uv[j] = centroid(mesh_.uv[q.a], mesh_.uv[q.b], mesh_.uv[q.c]);
                places_.triangle[j] = some[j];
                places_.area[j] = area_[some[j]];
            }
            surface.read(all(places_.uv), 1);
            for (std::size_t j = 0; j < some.size(); ++j)
                found_.cosine[some[j]] =
                    static_cast<float>(cosine(some[j], cross(surface[1][j], surface[2][j])));
            measure_read(surface);
            for (std::size_t j = 0; j < some.size(); ++j)
                add(some[j], places_.squared[j], CENTROID_WEIGHT);
        });
    }

    /// Triangles in a plane by the heights of their corners; ``others_`` are those that are not.
    void in_plane(const HeightAbove& height, std::span<const std::int32_t> members) {
        others_.clear();
        for (const std::int32_t t : members) {
            if (in_plane_[t] == 0) {
                others_.push_back(t);
                continue;
            }
            const TriangleCorners& k = mesh_.triangles[t];
            const double a = height(mesh_.points[k.a]), b = height(mesh_.points[k.b]),
                         c = height(mesh_.points[k.c]);
            const double ab = 0.25 * (a + b) * (a + b), bc = 0.25 * (b + c) * (b + c),
                         ca = 0.25 * (c + a) * (c + a), abc = (a + b + c) * (a + b + c) / 9.0;
            found_.largest[t] = std::max({ab, bc, ca, abc});
            found_.mean_square[t] = MIDDLE_WEIGHT * (ab + bc + ca) + CENTROID_WEIGHT * abc;
            found_.cosine[t] = static_cast<float>(cosine(t, height.normal()));
        }
    }

    void add_at_middle(const EdgeSides& sides, double squared) {
        for (const HalfEdge side : {sides.half_edge, sides.twin})
            if (side != NIL && in_plane_[side / 3] == 0) add(side / 3, squared, MIDDLE_WEIGHT);
    }

    void measure(SurfaceReader& surface) {
        surface.read(all(places_.uv), 1);
        measure_read(surface);
    }

    /// In the tangent planes at the feet that are read, where these are near, else in those a Newton
    /// step further, else to the nearest point.
    void measure_read(SurfaceReader& surface) {
        const ParameterBox domain = surface.domain();
        far_.clear();
        for (std::size_t j = 0; j < places_.points.size(); ++j) {
            const Offset offset(places_.points[j], surface[0][j], surface[1][j], surface[2][j]);
            places_.squared[j] = offset.along;
            if (is_near(offset, j)) continue;
            const Point2 to = places_.uv[j] + offset.step(surface[1][j], surface[2][j]);
            far_.add(static_cast<std::int32_t>(j), within(domain, to), offset.whole);
        }
        if (far_.places.empty()) return;
        surface.read(all(far_.uv), 1);
        left_.clear();
        for (std::size_t k = 0; k < far_.places.size(); ++k) {
            const std::int32_t j = far_.places[k];
            const Offset offset(places_.points[j], surface[0][k], surface[1][k], surface[2][k]);
            places_.squared[j] = offset.along;
            if (!is_near(offset, j) || !(offset.whole <= far_.whole[k])) left_.push_back(j);
        }
        if (left_.empty()) return;
        set_distances(closest_points_across_sides(surface, all(chosen(places_.points)),
                                                  all(chosen(places_.uv)), PROJECTION_STEPS)
                          .distance);
        look_from_corners(surface);
    }

    /// Of the places ``left_`` whose feet are far: is there a nearer one that a search from the
    /// corners finds? Where sides are bent the middle of parameters may lie far from the triangle.
    void look_from_corners(SurfaceReader& surface) {
        std::size_t kept = 0;
        for (const std::int32_t j : left_)
            if (places_.squared[j] > ASTRAY * ASTRAY * places_.area[j]) left_[kept++] = j;
        left_.resize(kept);
        if (left_.empty()) return;
        Array<ParameterTriangle> corners;
        Array<std::int64_t> own;
        for (const std::int32_t j : left_) {
            const TriangleCorners& q = mesh_.uv_triangles[places_.triangle[j]];
            own.push_back(static_cast<std::int64_t>(corners.size()));
            corners.push_back({mesh_.uv[q.a], mesh_.uv[q.b], mesh_.uv[q.c]});
        }
        const ClosestPoints found = closest_points_in_triangles(
            surface, all(chosen(places_.points)), all(chosen(places_.uv)), all(corners), all(own),
            0.0, PATIENT_STEPS);
        for (std::size_t k = 0; k < left_.size(); ++k) {
            double& squared = places_.squared[left_[k]];
            squared = std::min(squared, found.distance[k] * found.distance[k]);
        }
    }

    [[nodiscard]] bool is_near(const Offset& offset, std::size_t j) const {
        return offset.across <= NEAR_FOOT * NEAR_FOOT * places_.area[j];
    }

    /// The same of vertices, which should be r(u, v) itself.
    void measure_vertices(SurfaceReader& surface) {
        surface.read(all(places_.uv), 0);
        left_.clear();
        for (std::size_t j = 0; j < places_.points.size(); ++j) {
            const Point3 gap = places_.points[j] - surface[0][j];
            places_.squared[j] = dot(gap, gap);
            if (!(places_.squared[j] <= ON_SURFACE * ON_SURFACE * places_.area[j]))
                left_.push_back(static_cast<std::int32_t>(j));
        }
        if (left_.empty()) return;
        Array<double> size = chosen(places_.area);
        for (double& area : size) area = std::sqrt(area);
        set_distances(vertex_deviations(surface, all(chosen(places_.points)),
                                        all(chosen(places_.uv)), all(size)));
    }

    /// Of the places ``left_``.
    template <class T>
    [[nodiscard]] Array<T> chosen(const Array<T>& values) const {
        Array<T> some;
        some.reserve(left_.size());
        for (const std::int32_t j : left_) some.push_back(values[j]);
        return some;
    }

    void set_distances(const Array<double>& distance) {
        for (std::size_t k = 0; k < left_.size(); ++k)
            places_.squared[left_[k]] = distance[k] * distance[k];
    }

    void add(std::int32_t triangle, double squared, double weight) {
        found_.mean_square[triangle] += weight * squared;
        found_.largest[triangle] = larger(found_.largest[triangle], squared);
    }

    /// Between the normal of a triangle and one of any length.
    [[nodiscard]] double cosine(std::int32_t triangle, Point3 normal) const {
        const double squared = dot(normal, normal);
        if (!(squared > 0.0)) return 1.0;
        const TriangleCorners& t = mesh_.triangles[triangle];
        const double length = 2.0 * area_[triangle];
        if (length == 0.0) return 1.0;
        const Point3 own =
            cross(mesh_.points[t.b] - mesh_.points[t.a], mesh_.points[t.c] - mesh_.points[t.a]);
        return length > 0.0 ? dot(own, normal) / (length * std::sqrt(squared))
                            : std::numeric_limits<double>::quiet_NaN();
    }

    /// Distances of vertices, and all from their squares.
    void add_vertices() {
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            const TriangleCorners& k = mesh_.triangles[t];
            const double a = at_vertex_[k.a], b = at_vertex_[k.b], c = at_vertex_[k.c];
            found_.mean_square[t] += VERTEX_WEIGHT * (a + b + c);
            found_.largest[t] = std::sqrt(larger(larger(larger(found_.largest[t], a), b), c));
        }
    }

    const MeasuredMesh& mesh_;
    Array<EdgeSides> edges_;
    std::span<const double> area_;
    std::span<const std::uint8_t> in_plane_;
    Array<double> at_vertex_;     // squares of distances, as those of triangles until the end
    Array<std::int32_t> others_;  // of a plane: what is looked at as on any surface
    MeshDeviation found_;
    Places places_;
    FarPlaces far_;
    Array<std::int32_t> left_;
};

}  // namespace

MeshDeviation mesh_deviation(const MeasuredMesh& mesh, std::span<const EdgeSides> edges,
                             std::span<const double> area, std::span<const std::uint8_t> in_plane) {
    return Measure(mesh, edges, area, in_plane).run();
}

}  // namespace surfmesh
