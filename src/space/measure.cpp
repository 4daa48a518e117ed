#include "space/measure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "elementary_functions/inverse_trigonometric.hpp"

namespace surfmesh {
namespace {

constexpr double DEGREES = 180.0 / std::numbers::pi;

/// The angles of a triangle are atan2(twice_area, x), (y) and (z): they fall as x, y, z rise.
struct AngleArguments {
    double twice_area, x, y, z;

    [[nodiscard]] double low() const { return std::min(std::min(x, y), z); }
    [[nodiscard]] double high() const { return std::max(std::max(x, y), z); }

    /// Is the one between clearly apart from both? Then it needs no arc tangent.
    [[nodiscard]] bool are_clearly_apart() const {
        constexpr double CLEARLY = 1e-9;  // of the largest: what rounding of an angle cannot bridge
        const double between = std::max(std::min(x, y), std::min(std::max(x, y), z));
        const double apart = CLEARLY * high();
        return between > 0.0 && high() - between > apart && between - low() > apart;
    }
};

/// The shapes of triangles. Arc tangents are gathered: many at once take half the time.
class ShapeMeasure {
  public:
    explicit ShapeMeasure(std::size_t triangles) {
        shapes_.area.reserve(triangles);
        shapes_.alpha.reserve(triangles);
        shapes_.radius_ratio.reserve(triangles);
        shapes_.least_angle.reserve(triangles);
        shapes_.largest_angle.reserve(triangles);
    }

    void add(Point3 a, Point3 b, Point3 c) {
        const Point3 ab = b - a, ac = c - a, bc = c - b;
        const double twice_area = norm(cross(ab, ac));
        const double ab2 = dot(ab, ab), ac2 = dot(ac, ac), bc2 = dot(bc, bc);
        const double total = ab2 + bc2 + ac2;
        if (!(total > 0.0)) {
            add_figures(0.0, 0.0, 0.0);
            return gather({0.0, 1.0, 1.0, 1.0});  // no angle
        }
        const double lab = std::sqrt(ab2), lac = std::sqrt(ac2), lbc = std::sqrt(bc2);
        const double product = lab * lac * lbc * (lab + lac + lbc);
        // r_in = 2 A / perimeter, r_circum = abc / 4 A
        const double ratio = product > 0.0 ? 4.0 * twice_area * twice_area / product : 0.0;
        add_figures(0.5 * twice_area, 2.0 * std::sqrt(3.0) * twice_area / total, ratio);
        // products of edges, not the law of cosines: its squares cancel in needles
        gather({twice_area, dot(ab, ac), -dot(ab, bc), dot(ac, bc)});
    }

    TriangleShapes done() {
        take_angles();
        return std::move(shapes_);
    }

  private:
    static constexpr std::size_t GATHERED = 256;  // angles

    void add_figures(double area, double alpha, double radius_ratio) {
        shapes_.area.push_back(area);
        shapes_.alpha.push_back(alpha);
        shapes_.radius_ratio.push_back(radius_ratio);
    }

    void gather(const AngleArguments& of) {
        above_[count_] = above_[count_ + 1] = of.twice_area;
        beside_[count_] = of.high();
        beside_[count_ + 1] = of.low();
        arguments_[count_ / 2] = of;
        count_ += 2;
        if (count_ == GATHERED) take_angles();
    }

    void take_angles() {
        elementary::atan2({above_.data(), count_}, {beside_.data(), count_},
                          {angles_.data(), count_});
        for (std::size_t k = 0; k < count_; k += 2) {
            double least = angles_[k], largest = angles_[k + 1];
            if (const AngleArguments& of = arguments_[k / 2]; !of.are_clearly_apart()) {
                const double at_x = elementary::atan2(of.twice_area, of.x);
                const double at_y = elementary::atan2(of.twice_area, of.y);
                const double at_z = elementary::atan2(of.twice_area, of.z);
                least = std::min(std::min(at_x, at_y), at_z);
                largest = std::max(std::max(at_x, at_y), at_z);
            }
            shapes_.least_angle.push_back(least * DEGREES);
            shapes_.largest_angle.push_back(largest * DEGREES);
        }
        count_ = 0;
    }

    TriangleShapes shapes_;
    std::array<double, GATHERED> above_, beside_, angles_;
    std::array<AngleArguments, GATHERED / 2> arguments_;
    std::size_t count_ = 0;
};

}  // namespace

TriangleShapes triangle_shapes(std::span<const Point3> points,
                               std::span<const TriangleCorners> triangles) {
    ShapeMeasure measure(triangles.size());
    for (const auto& [a, b, c] : triangles) measure.add(points[a], points[b], points[c]);
    return measure.done();
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
