#include "patch/deviation.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/power.hpp"
#include "patch/samples.hpp"
#include "space/measure.hpp"

namespace surfmesh {
namespace {

// Of the triangle's size. With d near k h^2 / 8 for the distance to the tangent plane at a foot
// that is off by s, the true distance differs by k s^2 / 2 = 4 d (s / h)^2: 1 % of d at this s / h.
constexpr double NEAR_FOOT = 0.05;
constexpr double ON_SURFACE = 1e-9;  // of the size: a vertex this near to r(u, v) is on it
constexpr double FAR_FOOT = 0.2;     // of the longest side: r(u, v) so far across says nothing
constexpr double NEAR_LIMIT = 0.94;  // of the limit: from there the few samples do not suffice
constexpr double UNSURE = 2.0;       // times what they miss a quadric by, the error of their peak
constexpr int STEPS = 12;     // of a projection, at most: where speeds change fast guesses are poor
constexpr int FEW_STEPS = 4;  // in the mesher, where triangles are small and guesses near
constexpr std::size_t BLOCK = 2048;  // triangles looked at together

/// Points seen from the tangent planes at uv.
Array<TangentPlaneOffset> offsets(SurfaceReader& surface, std::span<const Point3> points,
                                  std::span<const Point2> uv) {
    surface.read(uv, 1);
    Array<TangentPlaneOffset> found(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        found[i] = tangent_plane_offset(points[i], {surface[0][i], surface[1][i], surface[2][i]});
    return found;
}

template <class T>
Array<T> chosen(std::span<const T> values, const Array<std::int32_t>& which) {
    Array<T> some;
    some.reserve(which.size());
    for (const std::int32_t i : which) some.push_back(values[i]);
    return some;
}

template <class T>
std::span<const T> all(const Array<T>& values) {
    return {values.data(), values.size()};
}

/// uv, moved by the steps of their offsets and kept within the domain.
Array<Point2> a_step_further(const ParameterBox& box, std::span<const Point2> uv,
                             const Array<TangentPlaneOffset>& found,
                             const Array<std::int32_t>& which) {
    Array<Point2> nearer;
    for (const std::int32_t i : which) {
        const Point2 to = uv[i] + found[i].step;
        nearer.push_back({std::min(std::max(to.x, box.low.x), box.high.x),
                          std::min(std::max(to.y, box.low.y), box.high.y)});
    }
    return nearer;
}

/// Look again at the points ``far`` a Newton step further: those that are left.
Array<std::int32_t> look_again(SurfaceReader& surface, std::span<const Point3> points,
                               std::span<const Point2> uv, std::span<const double> size,
                               const Array<TangentPlaneOffset>& found,
                               const Array<std::int32_t>& far, Array<double>& distance) {
    const Array<Point2> nearer = a_step_further(surface.domain(), uv, found, far);
    const Array<TangentPlaneOffset> again = offsets(surface, all(chosen(points, far)), all(nearer));
    Array<std::int32_t> left;
    for (std::size_t k = 0; k < far.size(); ++k) {
        const std::int32_t i = far[k];
        distance[i] = again[k].along;
        const bool better = elementary::hypot(again[k].along, again[k].across) <=
                            elementary::hypot(found[i].along, found[i].across);
        if (!(again[k].across <= NEAR_FOOT * size[i] && better)) left.push_back(i);
    }
    return left;
}

/// A block of triangles with the distance of each from the surface.
struct TriangleBlock {
    std::span<const SpaceTriangle> corners;
    std::span<const PlaneTriangle> xy;
    std::span<double> error;
};

double longest_side(const SpaceTriangle& t) {
    return std::max({norm(t[0] - t[1]), norm(t[1] - t[2]), norm(t[2] - t[0])});
}

/// Heights of the surface over a triangle: in the middles of the sides, and at the centroid.
using FewHeights = std::array<double, FEW_SAMPLES.size()>;

/// Over a quadric the height is 4 (a l1 l2 + b l2 l3 + c l3 l1), with a, b and c those in the
/// middles of the sides: its largest absolute value in the triangle.
double peak_of_quadric(double a, double b, double c) {
    const double on_side = std::max({std::abs(a), std::abs(b), std::abs(c)});
    // where the gradient is alike in all directions: l1, l2, l3 as these three
    const double l1 = b * (a + c - b), l2 = c * (a + b - c), l3 = a * (b + c - a);
    const double sum = l1 + l2 + l3;
    const bool inside =
        sum > 0.0 ? l1 > 0.0 && l2 > 0.0 && l3 > 0.0 : l1 < 0.0 && l2 < 0.0 && l3 < 0.0;
    return inside ? std::max(on_side, std::abs(4.0 * a * b * c / sum)) : on_side;
}

/// The largest distance between and at few samples, with an allowance for what is no quadric.
double peak_of_few(const FewHeights& h) {
    const double at_centroid = 4.0 / 9.0 * (h[0] + h[1] + h[2]);
    return std::max(peak_of_quadric(h[0], h[1], h[2]), std::abs(h[3])) +
           UNSURE * std::abs(h[3] - at_centroid);
}

/// Fill in the distances as a few samples have them; the triangles that need a closer look.
Array<std::int32_t> look_at_few(SurfaceReader& surface, const Chart& chart,
                                const TriangleBlock& block, double limit) {
    const std::size_t count = block.corners.size();
    Array<Point2> uv(count);
    Array<FewHeights> height(count);
    Array<std::uint8_t> unreliable(count, 0);
    for (std::size_t k = 0; k < FEW_SAMPLES.size(); ++k) {
        const BarycentricWeights& w = FEW_SAMPLES[k];
        for (std::size_t i = 0; i < count; ++i) uv[i] = chart.to_uv(at_weights(block.xy[i], w));
        surface.read(all(uv), 1);
        for (std::size_t i = 0; i < count; ++i) {
            const Point3 point = at_weights(block.corners[i], w);
            const TangentPlaneOffset found =
                tangent_plane_offset(point, {surface[0][i], surface[1][i], surface[2][i]});
            const bool below = dot(found.normal, point - surface[0][i]) < 0.0;
            height[i][k] = below ? -found.along : found.along;
            if (found.across > FAR_FOOT * longest_side(block.corners[i])) unreliable[i] = 1;
        }
    }
    Array<std::int32_t> close;
    for (std::size_t i = 0; i < count; ++i) {
        block.error[i] = peak_of_few(height[i]);
        if (unreliable[i] || block.error[i] > NEAR_LIMIT * limit)
            close.push_back(static_cast<std::int32_t>(i));
    }
    return close;
}

/// Fill in the distances of triangles at many samples, each with its nearest point.
void look_at_many(SurfaceReader& surface, const Chart& chart, const TriangleBlock& block,
                  const Array<std::int32_t>& close, double limit) {
    Array<Point3> points;
    Array<Point2> uv;
    Array<std::int64_t> triangle;
    Array<ParameterTriangle> corners;
    for (std::size_t k = 0; k < close.size(); ++k) {
        const std::int32_t i = close[k];
        for (const BarycentricWeights& w : DENSE_SAMPLES) {
            points.push_back(at_weights(block.corners[i], w));
            uv.push_back(chart.to_uv(at_weights(block.xy[i], w)));
            triangle.push_back(static_cast<std::int64_t>(k));
        }
        corners.push_back({chart.to_uv(block.xy[i][0]), chart.to_uv(block.xy[i][1]),
                           chart.to_uv(block.xy[i][2])});
        block.error[i] = 0.0;
    }
    const ClosestPoints found =
        closest_points_in_triangles(surface, all(points), all(uv), all(corners), all(triangle),
                                    CHORD_MARGIN * limit, FEW_STEPS);
    for (std::size_t k = 0; k < points.size(); ++k) {
        double& error = block.error[close[triangle[k]]];
        error = std::max(error, found.distance[k]);
    }
}

}  // namespace

PointDeviations point_deviations(SurfaceReader& surface, std::span<const Point3> points,
                                 std::span<const Point2> uv, std::span<const double> size) {
    const Array<TangentPlaneOffset> found = offsets(surface, points, uv);
    PointDeviations result{Array<double>(points.size()), Array<Point3>(points.size())};
    Array<std::int32_t> far;
    for (std::size_t i = 0; i < points.size(); ++i) {
        result.distance[i] = found[i].along;
        result.normal[i] = found[i].normal;
        if (!(found[i].across <= NEAR_FOOT * size[i])) far.push_back(static_cast<std::int32_t>(i));
    }
    if (!far.empty()) far = look_again(surface, points, uv, size, found, far, result.distance);
    if (far.empty()) return result;
    const ClosestPoints closest =
        closest_points(surface, all(chosen(points, far)), all(chosen(uv, far)), STEPS);
    for (std::size_t k = 0; k < far.size(); ++k) result.distance[far[k]] = closest.distance[k];
    return result;
}

Array<double> vertex_deviations(SurfaceReader& surface, std::span<const Point3> points,
                                std::span<const Point2> uv, std::span<const double> size) {
    surface.read(uv, 0);
    Array<double> distance(points.size());
    Array<std::int32_t> off;
    for (std::size_t i = 0; i < points.size(); ++i) {
        distance[i] = norm(points[i] - surface[0][i]);
        if (!(distance[i] <= ON_SURFACE * size[i])) off.push_back(static_cast<std::int32_t>(i));
    }
    if (off.empty()) return distance;
    const PointDeviations closely = point_deviations(surface, all(chosen(points, off)),
                                                     all(chosen(uv, off)), all(chosen(size, off)));
    for (std::size_t k = 0; k < off.size(); ++k) distance[off[k]] = closely.distance[k];
    return distance;
}

Array<double> triangle_deviations(SurfaceReader& surface, const Chart& chart,
                                  std::span<const SpaceTriangle> corners,
                                  std::span<const PlaneTriangle> xy, double limit) {
    Array<double> error(corners.size(), 0.0);
    surface.for_each_block(
        corners.size(), BLOCK, [&](SurfaceReader& reader, std::size_t first, std::size_t last) {
            const std::size_t count = last - first;
            const TriangleBlock block{corners.subspan(first, count),
                                      xy.subspan(first, count),
                                      {error.data() + first, count}};
            const Array<std::int32_t> close = look_at_few(reader, chart, block, limit);
            if (!close.empty()) look_at_many(reader, chart, block, close, limit);
        });
    return error;
}

}  // namespace surfmesh
