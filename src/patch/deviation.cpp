#include "patch/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "elementary_functions/power.hpp"
#include "patch/samples.hpp"
#include "space/measure.hpp"

namespace surfmesh {
namespace {

constexpr double ON_SURFACE = 1e-9;  // of the size: a vertex this near to r(u, v) is on it
constexpr double FAR_FOOT = 0.2;     // of the longest side: r(u, v) so far across says nothing
constexpr double CLOSE_FOOT = 0.02;  // the same of a triangle's height: 0.2 % of d
constexpr double NEAR_LIMIT = 0.88;  // of the limit: a quadric may be 4.2 % farther between samples
constexpr int FEW_STEPS = 4;         // in the mesher, where triangles are small and guesses near
constexpr std::size_t SAMPLED_TOGETHER = 2048;  // triangles looked at together

/// Of a point from the tangent plane at a place of the surface: its normal, zero where there is
/// none, and the distances along it and across.
struct NormalOffset {
    Point3 normal;
    double along, across;
};

/// As ``tangent_plane_offset`` has it, without the step that few points take.
NormalOffset normal_offset(Point3 point, Point3 foot, Point3 ru, Point3 rv) {
    const Point3 n = cross(ru, rv), d = point - foot;
    const double length = norm(n), squared = dot(d, d);
    if (!(length > 0.0)) return {{0.0, 0.0, 0.0}, std::sqrt(squared), std::sqrt(squared)};
    const Point3 normal = {n.x / length, n.y / length, n.z / length};
    const double along = dot(d, normal);
    return {normal, std::abs(along), std::sqrt(std::max(squared - along * along, 0.0))};
}

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

/// uv of some points, moved by the steps of their offsets and kept within the domain.
Array<Point2> a_step_further(const ParameterBox& box, std::span<const Point2> uv,
                             const Array<TangentPlaneOffset>& found,
                             const Array<std::int32_t>& which) {
    Array<Point2> nearer;
    for (std::size_t k = 0; k < which.size(); ++k) {
        const Point2 to = uv[which[k]] + found[k].step;
        nearer.push_back({std::min(std::max(to.x, box.low.x), box.high.x),
                          std::min(std::max(to.y, box.low.y), box.high.y)});
    }
    return nearer;
}

/// Look again at the points ``far``, whose offsets these are, a Newton step further: those that are
/// left.
Array<std::int32_t> look_again(SurfaceReader& surface, std::span<const Point3> points,
                               std::span<const Point2> uv, std::span<const double> size,
                               const Array<TangentPlaneOffset>& found,
                               const Array<std::int32_t>& far, Array<double>& distance) {
    const Array<Point2> nearer = a_step_further(surface.domain(), uv, found, far);
    const Array<TangentPlaneOffset> again = offsets(surface, chosen(points, far), nearer);
    Array<std::int32_t> left;
    for (std::size_t k = 0; k < far.size(); ++k) {
        const std::int32_t i = far[k];
        distance[i] = again[k].along;
        const bool better = elementary::hypot(again[k].along, again[k].across) <=
                            elementary::hypot(found[k].along, found[k].across);
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

/// Of a sample, squared: its distance along the normal at its foot, and from the foot itself.
struct SquaredOffset {
    double along, whole;
};

SquaredOffset squared_offset(Point3 point, Point3 foot, Point3 ru, Point3 rv) {
    const Point3 n = cross(ru, rv), gap = point - foot;
    const double squared = dot(n, n), whole = dot(gap, gap), high = dot(gap, n);
    return {squared > 0.0 ? high * high / squared : whole, whole};
}

/// The offsets at one sample of triangles of a block, from ``offsets`` on.
void measure_at(SurfaceReader& surface, const Chart& chart, const TriangleBlock& block,
                const Array<std::int32_t>& triangles, const BarycentricWeights& w,
                std::span<SquaredOffset> offsets) {
    const std::size_t count = triangles.size();
    Array<Point2> xy(count);
    for (std::size_t k = 0; k < count; ++k) xy[k] = at_weights(block.xy[triangles[k]], w);
    surface.read(chart.to_uv(xy), 1);
    for (std::size_t k = 0; k < count; ++k)
        offsets[k] = squared_offset(at_weights(block.corners[triangles[k]], w), surface[0][k],
                                    surface[1][k], surface[2][k]);
}

/// Squares of the longest side and of the height over it.
struct SquaredExtent {
    double longest, height;

    explicit SquaredExtent(const SpaceTriangle& t) {
        const Point3 a = t[1] - t[0], b = t[2] - t[0], c = t[2] - t[1], n = cross(a, b);
        longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
        height = longest > 0.0 ? dot(n, n) / longest : 0.0;
    }
};

/// Offsets of the triangles of a block at the first samples, row by row, and who needs more.
struct FewSamples {
    Array<SquaredOffset> offsets;
    Array<std::int32_t> close;
};

/// Fill in the distances at a few samples.
FewSamples look_at_few(SurfaceReader& surface, const Chart& chart, const TriangleBlock& block,
                       double limit) {
    const std::size_t count = block.corners.size();
    FewSamples found{Array<SquaredOffset>(FEW_SAMPLES.size() * count), {}};
    Array<std::int32_t> every(count);
    std::iota(every.begin(), every.end(), 0);
    for (std::size_t n = 0; n < FEW_SAMPLES.size(); ++n)
        measure_at(surface, chart, block, every, FEW_SAMPLES[n],
                   {found.offsets.data() + n * count, count});
    for (std::size_t i = 0; i < count; ++i) {
        double largest = 0.0, across = 0.0;
        for (std::size_t n = 0; n < FEW_SAMPLES.size(); ++n) {
            const SquaredOffset& at = found.offsets[n * count + i];
            largest = std::max(largest, at.along);
            across = std::max(across, at.whole - at.along);
        }
        block.error[i] = std::sqrt(largest);
        const double far = FAR_FOOT * FAR_FOOT * SquaredExtent(block.corners[i]).longest;
        if (!(across <= far) || !(block.error[i] <= NEAR_LIMIT * limit))
            found.close.push_back(static_cast<std::int32_t>(i));
    }
    return found;
}

/// Samples whose nearest points are searched for.
struct Searches {
    Array<Point3> points;
    Array<Point2> uv;
    Array<std::int64_t> triangle;

    void add(const Chart& chart, const TriangleBlock& block, std::int32_t i,
             const BarycentricWeights& w, std::size_t k) {
        points.push_back(at_weights(block.corners[i], w));
        uv.push_back(chart.to_uv(at_weights(block.xy[i], w)));
        triangle.push_back(static_cast<std::int64_t>(k));
    }
};

/// Raise the distances of triangles to those of the searches.
void search(SurfaceReader& surface, const Chart& chart, const TriangleBlock& block,
            const Array<std::int32_t>& close, const Searches& left, double limit) {
    if (left.points.empty()) return;
    Array<ParameterTriangle> corners;
    for (const std::int32_t i : close)
        corners.push_back({chart.to_uv(block.xy[i][0]), chart.to_uv(block.xy[i][1]),
                           chart.to_uv(block.xy[i][2])});
    const ClosestPoints found = closest_points_in_triangles(
        surface, left.points, left.uv, corners, left.triangle, CHORD_MARGIN * limit, FEW_STEPS);
    for (std::size_t k = 0; k < left.points.size(); ++k) {
        double& error = block.error[close[left.triangle[k]]];
        error = std::max(error, found.distance[k]);
    }
}

/// Fill in the distances of the triangles ``few.close`` at many samples.
///
/// What is surely within the margin of the limit needs no search: the foot is as near, or it is
/// near enough for its tangent plane to say so.
void look_at_many(SurfaceReader& surface, const Chart& chart, const TriangleBlock& block,
                  const FewSamples& few, double limit) {
    const Array<std::int32_t>& close = few.close;
    const double within = CHORD_MARGIN * limit * CHORD_MARGIN * limit;
    Array<double> largest(close.size(), 0.0), near(close.size());
    for (std::size_t k = 0; k < close.size(); ++k)
        near[k] = CLOSE_FOOT * CLOSE_FOOT * SquaredExtent(block.corners[close[k]]).height;
    Searches left;
    const auto judge = [&](std::size_t k, const SquaredOffset& at, const BarycentricWeights& w) {
        if (at.whole <= within)
            largest[k] = std::max(largest[k], at.along);
        else if (at.along <= within && at.whole - at.along <= near[k])
            largest[k] = std::max(largest[k], at.along);
        else
            left.add(chart, block, close[k], w, k);
    };
    for (std::size_t n = 0; n < FEW_SAMPLES.size(); ++n)
        for (std::size_t k = 0; k < close.size(); ++k)
            judge(k, few.offsets[n * block.corners.size() + close[k]], FEW_SAMPLES[n]);
    Array<SquaredOffset> offsets(close.size());
    for (const BarycentricWeights& w : OTHER_SAMPLES) {
        measure_at(surface, chart, block, close, w, offsets);
        for (std::size_t k = 0; k < close.size(); ++k) judge(k, offsets[k], w);
    }
    for (std::size_t k = 0; k < close.size(); ++k) block.error[close[k]] = std::sqrt(largest[k]);
    search(surface, chart, block, close, left, limit);
}

}  // namespace

Array<double> triangle_widths(SurfaceReader& surface, const Chart& chart,
                              std::span<const SpaceTriangle> corners,
                              std::span<const PlaneTriangle> xy, Array<double> deviation) {
    surface.for_each_block(
        corners.size(), SAMPLED_TOGETHER,
        [&](SurfaceReader& reader, std::size_t first, std::size_t last) {
            const std::size_t count = last - first;
            Array<double> high(count, 0.0), low(count, 0.0);  // the corners are on the surface
            Array<Point2> uv(count);
            for (const BarycentricWeights& w : FEW_SAMPLES) {
                for (std::size_t i = 0; i < count; ++i)
                    uv[i] = chart.to_uv(at_weights(xy[first + i], w));
                reader.read(uv, 1);
                for (std::size_t i = 0; i < count; ++i) {
                    const Point3 point = at_weights(corners[first + i], w);
                    const TangentPlaneOffset found =
                        tangent_plane_offset(point, {reader[0][i], reader[1][i], reader[2][i]});
                    const double along = dot(found.normal, point - reader[0][i]);
                    high[i] = std::max(high[i], along);
                    low[i] = std::min(low[i], along);
                }
            }
            for (std::size_t i = 0; i < count; ++i) {
                double& found = deviation[first + i];
                found += std::min(high[i], -low[i]);  // of the side that has less
            }
        });
    return deviation;
}

PointDeviations point_deviations(SurfaceReader& surface, std::span<const Point3> points,
                                 std::span<const Point2> uv, std::span<const double> size) {
    surface.read(uv, 1);
    PointDeviations result;
    result.distance.reserve(points.size());
    result.normal.reserve(points.size());
    Array<std::int32_t> far;
    Array<TangentPlaneOffset> found;  // of those
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point3 &foot = surface[0][i], &ru = surface[1][i], &rv = surface[2][i];
        const NormalOffset offset = normal_offset(points[i], foot, ru, rv);
        result.distance.push_back(offset.along);
        result.normal.push_back(offset.normal);
        if (offset.across <= NEAR_FOOT * size[i]) continue;
        far.push_back(static_cast<std::int32_t>(i));
        found.push_back(tangent_plane_offset(points[i], {foot, ru, rv}));
    }
    if (!far.empty()) far = look_again(surface, points, uv, size, found, far, result.distance);
    if (far.empty()) return result;
    const ClosestPoints closest = closest_points_across_sides(surface, chosen(points, far),
                                                              chosen(uv, far), PROJECTION_STEPS);
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
    const PointDeviations closely =
        point_deviations(surface, chosen(points, off), chosen(uv, off), chosen(size, off));
    for (std::size_t k = 0; k < off.size(); ++k) distance[off[k]] = closely.distance[k];
    return distance;
}

Array<double> triangle_deviations(SurfaceReader& surface, const Chart& chart,
                                  std::span<const SpaceTriangle> corners,
                                  std::span<const PlaneTriangle> xy, double limit) {
    Array<double> error(corners.size(), 0.0);
    surface.for_each_block(corners.size(), SAMPLED_TOGETHER,
                           [&](SurfaceReader& reader, std::size_t first, std::size_t last) {
                               const std::size_t count = last - first;
                               const TriangleBlock block{corners.subspan(first, count),
                                                         xy.subspan(first, count),
                                                         {error.data() + first, count}};
                               const FewSamples few = look_at_few(reader, chart, block, limit);
                               if (!few.close.empty())
                                   look_at_many(reader, chart, block, few, limit);
                           });
    return error;
}

}  // namespace surfmesh
