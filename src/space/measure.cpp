#include "space/measure.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "elementary_functions/inverse_trigonometric.hpp"

namespace surfmesh {
namespace {

/// The least and the largest of the angles atan2(twice_area, x), (y), (z). They fall as x, y, z rise:
/// where these are clearly apart the one between needs no arc tangent.
std::pair<double, double> extreme_angles(double twice_area, double x, double y, double z) {
    constexpr double CLEARLY = 1e-9;  // of the largest: what rounding of an angle cannot bridge
    const double low = std::min(std::min(x, y), z), high = std::max(std::max(x, y), z);
    const double between = std::max(std::min(x, y), std::min(std::max(x, y), z));
    const double apart = CLEARLY * high;
    if (between > 0.0 && high - between > apart && between - low > apart)
        return {elementary::atan2(twice_area, high), elementary::atan2(twice_area, low)};
    const double at_x = elementary::atan2(twice_area, x);
    const double at_y = elementary::atan2(twice_area, y);
    const double at_z = elementary::atan2(twice_area, z);
    return {std::min(std::min(at_x, at_y), at_z), std::max(std::max(at_x, at_y), at_z)};
}

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
    std::tie(shape.least_angle, shape.largest_angle) =
        extreme_angles(twice_area, dot(ab, ac), -dot(ab, bc), dot(ac, bc));
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
