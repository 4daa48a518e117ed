#include "space/measure.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/inverse_trigonometric.hpp"

namespace surfmesh {
namespace {

TriangleShape triangle_shape(Point3 a, Point3 b, Point3 c) {
    const Point3 ab = b - a, ac = c - a, bc = c - b;
    const double twice_area = norm(cross(ab, ac));
    const double ab2 = dot(ab, ab), ac2 = dot(ac, ac), bc2 = dot(bc, bc);
    const double total = ab2 + bc2 + ac2;
    TriangleShape shape{0.0, 0.0, 0.0, 0.0, 0.0};
    if (!(total > 0.0)) return shape;
    shape.area = 0.5 * twice_area;
    shape.alpha = 2.0 * std::sqrt(3.0) * twice_area / total;
    const double lab = std::sqrt(ab2), lac = std::sqrt(ac2), lbc = std::sqrt(bc2);
    const double product = lab * lac * lbc * (lab + lac + lbc);
    if (product > 0.0)  // r_in = 2 A / perimeter, r_circum = abc / 4 A
        shape.radius_ratio = 4.0 * twice_area * twice_area / product;
    // products of edges, not the law of cosines: its squares cancel in needles
    const double at_a = elementary::atan2(twice_area, dot(ab, ac));
    const double at_b = elementary::atan2(twice_area, -dot(ab, bc));
    const double at_c = elementary::atan2(twice_area, dot(ac, bc));
    shape.least_angle = std::min(std::min(at_a, at_b), at_c);
    shape.largest_angle = std::max(std::max(at_a, at_b), at_c);
    return shape;
}

}  // namespace

Array<TriangleShape> triangle_shapes(std::span<const Point3> points,
                                     std::span<const TriangleCorners> triangles) {
    Array<TriangleShape> shapes;
    shapes.reserve(triangles.size());
    for (const auto& [a, b, c] : triangles)
        shapes.push_back(triangle_shape(points[a], points[b], points[c]));
    return shapes;
}

Array<double> interpolate(std::span<const double> corner_values, std::size_t dimension,
                          std::span<const TriangleCorners> triangles,
                          std::span<const std::int32_t> triangle,
                          std::span<const std::int32_t> rule, std::span<const Weights> weights) {
    Array<double> found;
    found.reserve(triangle.size() * dimension);
    for (std::size_t i = 0; i < triangle.size(); ++i) {
        const TriangleCorners& t = triangles[triangle[i]];
        const Weights& w = weights[rule[i]];
        const auto a = corner_values.subspan(t.a * dimension, dimension);
        const auto b = corner_values.subspan(t.b * dimension, dimension);
        const auto c = corner_values.subspan(t.c * dimension, dimension);
        for (std::size_t d = 0; d < dimension; ++d)
            found.push_back(w.a * a[d] + w.b * b[d] + w.c * c[d]);
    }
    return found;
}

TangentPlaneOffset tangent_plane_offset(Point3 point, const TangentPlane& plane) {
    const auto& [foot, ru, rv] = plane;
    Point3 n = cross(ru, rv);
    const double length = norm(n);
    const Point3 d = point - foot;
    const double squared = dot(d, d);
    if (!(length > 0.0)) {
        const double distance = std::sqrt(squared);
        return {{0.0, 0.0, 0.0}, distance, distance, {0.0, 0.0}};
    }
    n = {n.x / length, n.y / length, n.z / length};
    const double along = dot(d, n);
    // (d x r_v) . n = du |r_u x r_v| for d = du r_u + dv r_v, likewise for dv
    const Point2 step = {dot(cross(d, rv), n) / length, dot(cross(ru, d), n) / length};
    return {n, std::abs(along), std::sqrt(std::max(squared - along * along, 0.0)), step};
}

// Union-find with path halving, the smaller root wins.
Array<std::int32_t> component_labels(std::size_t count, std::span<const ThingPair> pairs) {
    Array<std::int32_t> parent(count);
    for (std::size_t i = 0; i < count; ++i) parent[i] = static_cast<std::int32_t>(i);
    const auto root = [&parent](std::int32_t a) {
        while (parent[a] != a) {
            parent[a] = parent[parent[a]];
            a = parent[a];
        }
        return a;
    };
    for (const ThingPair& pair : pairs) {
        const std::int32_t a = root(pair.first), b = root(pair.second);
        parent[std::max(a, b)] = std::min(a, b);
    }
    // parents are smaller, so theirs are final already
    for (std::int32_t& label : parent) label = parent[label];
    return parent;
}

}  // namespace surfmesh
