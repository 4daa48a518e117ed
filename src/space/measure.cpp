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

/// The shapes of triangles, block after block: numbers of one kind lie side by side, so that the
/// processor takes several triangles at a time, and many arc tangents at once.
class ShapeMeasure {
  public:
    ShapeMeasure(std::span<const Point3> points, std::span<const TriangleCorners> triangles)
        : points_(points), triangles_(triangles) {
        for (Array<double>* figures : {&shapes_.area, &shapes_.alpha, &shapes_.radius_ratio,
                                       &shapes_.least_angle, &shapes_.largest_angle})
            figures->reserve(triangles.size());
    }

    TriangleShapes run() {
        for (std::size_t first = 0; first < triangles_.size(); first += BLOCK) {
            const std::size_t count = std::min(BLOCK, triangles_.size() - first);
            take_sides(first, count);
            take_figures(count);
            leave_out_points(count);
            take_angles(count);
            for (std::size_t k = 0; k < count; ++k) add(k);
        }
        return std::move(shapes_);
    }

  private:
    static constexpr std::size_t BLOCK = 128;
    using Numbers = std::array<double, BLOCK>;
    struct Vectors {
        Numbers x, y, z;

        void set(std::size_t k, Point3 p) {
            x[k] = p.x;
            y[k] = p.y;
            z[k] = p.z;
        }
        Point3 operator[](std::size_t k) const { return {x[k], y[k], z[k]}; }
    };

    void take_sides(std::size_t first, std::size_t count) {
        for (std::size_t k = 0; k < count; ++k) {
            const TriangleCorners& t = triangles_[first + k];
            const Point3 a = points_[t.a], b = points_[t.b], c = points_[t.c];
            ab_.set(k, b - a);
            ac_.set(k, c - a);
            bc_.set(k, c - b);
        }
    }

    /// And the arguments of the angles, which are atan2(twice_area, x), (y) and (z): they fall as x,
    /// y, z rise. Loops without a condition, as compilers need them here.
    void take_figures(std::size_t count) {
        for (std::size_t k = 0; k < count; ++k) {
            const Point3 ab = ab_[k], ac = ac_[k], bc = bc_[k];
            const double twice_area = norm(cross(ab, ac));
            const double ab2 = dot(ab, ab), ac2 = dot(ac, ac), bc2 = dot(bc, bc);
            const double total = ab2 + bc2 + ac2;
            const double lab = std::sqrt(ab2), lac = std::sqrt(ac2), lbc = std::sqrt(bc2);
            const double product = lab * lac * lbc * (lab + lac + lbc);
            area_[k] = 0.5 * twice_area;
            alpha_[k] = 2.0 * std::sqrt(3.0) * twice_area / total;
            // r_in = 2 A / perimeter, r_circum = abc / 4 A
            ratio_[k] = 4.0 * twice_area * twice_area / product;
            twice_area_[k] = twice_area;
            // products of edges, not the law of cosines: its squares cancel in needles
            x_[k] = dot(ab, ac);
            y_[k] = -dot(ab, bc);
            z_[k] = dot(ac, bc);
            total_[k] = total;
            product_[k] = product;
        }
    }

    /// What has no size has no shape, and its angles no arguments.
    void leave_out_points(std::size_t count) {
        for (std::size_t k = 0; k < count; ++k) {
            const bool some = total_[k] > 0.0;
            const double area = area_[k], alpha = alpha_[k], ratio = ratio_[k];
            const double twice_area = twice_area_[k], x = x_[k], y = y_[k], z = z_[k];
            area_[k] = some ? area : 0.0;
            alpha_[k] = some ? alpha : 0.0;
            ratio_[k] = product_[k] > 0.0 ? ratio : 0.0;
            twice_area_[k] = some ? twice_area : 0.0;
            x_[k] = some ? x : 1.0;
            y_[k] = some ? y : 1.0;
            z_[k] = some ? z : 1.0;
        }
        for (std::size_t k = 0; k < count; ++k) {
            const double x = x_[k], y = y_[k], z = z_[k];
            const double less = y < x ? y : x, more = x < y ? y : x;
            low_[k] = z < less ? z : less;
            high_[k] = more < z ? z : more;
        }
    }

    void take_angles(std::size_t count) {
        elementary::atan2({twice_area_.data(), count}, {high_.data(), count},
                          {least_.data(), count});
        elementary::atan2({twice_area_.data(), count}, {low_.data(), count},
                          {largest_.data(), count});
        for (std::size_t k = 0; k < count; ++k) {
            if (is_clearly_between(k)) continue;
            const double at_x = elementary::atan2(twice_area_[k], x_[k]);
            const double at_y = elementary::atan2(twice_area_[k], y_[k]);
            const double at_z = elementary::atan2(twice_area_[k], z_[k]);
            least_[k] = std::min(std::min(at_x, at_y), at_z);
            largest_[k] = std::max(std::max(at_x, at_y), at_z);
        }
    }

    /// Is one of x, y, z clearly apart from both others, between them? Then its angle needs no arc
    /// tangent.
    [[nodiscard]] bool is_clearly_between(std::size_t k) const {
        constexpr double CLEARLY = 1e-9;  // of the largest: what rounding of an angle cannot bridge
        const double x = x_[k], y = y_[k], z = z_[k];
        const double between = std::max(std::min(x, y), std::min(std::max(x, y), z));
        const double apart = CLEARLY * high_[k];
        return between > 0.0 && high_[k] - between > apart && between - low_[k] > apart;
    }

    void add(std::size_t k) {
        shapes_.area.push_back(area_[k]);
        shapes_.alpha.push_back(alpha_[k]);
        shapes_.radius_ratio.push_back(ratio_[k]);
        shapes_.least_angle.push_back(least_[k] * DEGREES);
        shapes_.largest_angle.push_back(largest_[k] * DEGREES);
    }

    std::span<const Point3> points_;
    std::span<const TriangleCorners> triangles_;
    TriangleShapes shapes_;
    Vectors ab_, ac_, bc_;  // of a block of triangles, as all below
    Numbers area_, alpha_, ratio_, total_, product_;
    Numbers twice_area_, x_, y_, z_, low_, high_, least_, largest_;
};

}  // namespace

TriangleShapes triangle_shapes(std::span<const Point3> points,
                               std::span<const TriangleCorners> triangles) {
    return ShapeMeasure(points, triangles).run();
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
