#include "quality/triangle_stars.hpp"

#include <algorithm>
#include <limits>

#include "space/triangle_distance.hpp"

namespace surfmesh {
namespace {

/// How far x lies beyond the range of three numbers.
double beyond(double x, double a, double b, double c) {
    const double low = std::min(std::min(a, b), c), high = std::max(std::max(a, b), c);
    return std::max(std::max(low - x, x - high), 0.0);
}

/// Squared distance of a place from the box of three points.
double squared_from_box(Point3 place, Point3 a, Point3 b, Point3 c) {
    const Point3 off = {beyond(place.x, a.x, b.x, c.x), beyond(place.y, a.y, b.y, c.y),
                        beyond(place.z, a.z, b.z, c.z)};
    return dot(off, off);
}

}  // namespace

TriangleStars::TriangleStars(std::span<const Point3> points,
                             std::span<const TriangleCorners> triangles)
    : points_(points), corners_(triangles), members_(3 * triangles.size()) {
    first_.resize(points.size() + 1, 0);
    for (const TriangleCorners& t : triangles)
        for (const Vertex v : {t.a, t.b, t.c}) ++first_[v + 1];
    for (std::size_t v = 0; v < points.size(); ++v) first_[v + 1] += first_[v];
    Array<std::int32_t> next = first_;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (const Vertex v : {triangles[t].a, triangles[t].b, triangles[t].c})
            members_[next[v]++] = static_cast<std::int32_t>(t);
}

double TriangleStars::from(Point3 place, std::int32_t triangle) const {
    const TriangleCorners& t = corners_[triangle];
    return triangle_distance(place, {points_[t.a], points_[t.b], points_[t.c]});
}

double TriangleStars::walk(Point3 place, std::int32_t triangle, double distance) const {
    while (true) {
        double least = std::numeric_limits<double>::infinity();
        std::int32_t nearest = triangle;
        const TriangleCorners& t = corners_[triangle];
        for (const Vertex v : {t.a, t.b, t.c})
            for (const std::int32_t other : at(v)) {
                const double found = from(place, other);
                if (!(found < least)) continue;
                least = found;
                nearest = other;
            }
        if (!(least < distance)) return distance;
        distance = least;
        triangle = nearest;
    }
}

double TriangleStars::from_all(Point3 place, double distance) const {
    for (std::size_t t = 0; t < corners_.size(); ++t) {
        const TriangleCorners& k = corners_[t];
        const double apart = squared_from_box(place, points_[k.a], points_[k.b], points_[k.c]);
        if (apart >= distance * distance) continue;
        distance = std::min(distance, from(place, static_cast<std::int32_t>(t)));
    }
    return distance;
}

double TriangleStars::from_stars(Point3 place, std::span<const std::int32_t> vertices) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Vertex v : vertices)
        for (const std::int32_t triangle : at(v)) least = std::min(least, from(place, triangle));
    return least;
}

}  // namespace surfmesh
