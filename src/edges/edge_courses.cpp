#include "edges/edge_courses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "surfaces/fundamental_forms.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr double TINY = std::numeric_limits<double>::min();

Point3 divided(Point3 a, double by) { return {a.x / by, a.y / by, a.z / by}; }

/// |c' x c''| / |c'|^3; 0 where that is no number.
double curvature_of(Point3 first, Point3 second, double speed) {
    const Point3 bend = cross(first, second);
    const double curvature = norm(bend) / (speed * speed * speed);
    return std::isfinite(curvature) ? curvature : 0.0;
}

double turning_along(std::span<const Point3> tangents) {
    double sum = 0.0;
    for (std::size_t i = 1; i < tangents.size(); ++i)
        sum += elementary::acos(std::clamp(lane_dot(tangents[i], tangents[i - 1]), -1.0, 1.0));
    return sum;
}

void follow_line(const Curve& curve, std::span<const double> t, std::span<Point3> points,
                 std::span<Point3> tangents) {
    curve.evaluate(t, 0, points);
    if (points.empty()) return;
    const Point3 way = points.back() - points.front();
    std::fill(tangents.begin(), tangents.end(), divided(way, std::max(norm(way), TINY)));
}

}  // namespace

EdgeCourses edge_courses(const CurvePieces& pieces, const PiecePlaces& places,
                         std::span<const std::uint8_t> straight) {
    const std::size_t total = places.fraction.size();
    EdgeCourses found{Array<Point3>::unfilled(total), Array<Point3>::unfilled(total),
                      Array<double>::unfilled(total), Array<double>(places.which.size())};
    for_each_block(places.which.size(), PIECES_AT_ONCE, [&](std::size_t from, std::size_t to) {
        Array<double> t;
        Array<Point3> values;
        for (std::size_t i = from; i < to; ++i) {
            const Curve& curve = *pieces.curves[static_cast<std::size_t>(places.which[i])];
            parameters_of(pieces, places, i, t);
            const std::size_t start = places.start(i), count = t.size();
            const std::span<Point3> points(found.points.data() + start, count);
            const std::span<Point3> tangents(found.tangents.data() + start, count);
            if (straight[i]) {
                follow_line(curve, {t.data(), count}, points, tangents);
                std::fill_n(found.curvature.data() + start, count, 0.0);
                continue;
            }
            values.resize(3 * count);
            curve.evaluate({t.data(), count}, 2, {values.data(), 3 * count});
            for (std::size_t k = 0; k < count; ++k) {
                const Point3 first = values.data()[count + k];
                const double speed = norm(first);
                points[k] = values.data()[k];
                tangents[k] = divided(first, std::max(speed, TINY));
                found.curvature.data()[start + k] =
                    curvature_of(first, values.data()[2 * count + k], speed);
            }
            found.total_curvature.data()[i] = turning_along(tangents);
        }
    });
    return found;
}

namespace {

/// Principal curvatures at a block of places of one surface, from ``start`` on; whether it has any.
bool set_curvatures(const Surface& surface, std::span<const Point2> uv, std::size_t start,
                    SurfaceValues& values, SurfaceCurvatures& found) {
    if (values.evaluate(surface, uv, 2) != SurfaceStatus::DONE) return false;
    for (std::size_t k = 0; k < uv.size(); ++k) {
        const FundamentalForms forms = fundamental_forms(
            values[1][k], values[2][k], {values[3][k], values[4][k], values[5][k]});
        const PrincipalCurvatures own = principal_curvatures(forms);
        found.k1.data()[start + k] = own.k1;
        found.k2.data()[start + k] = own.k2;
        found.degenerate.data()[start + k] = forms.degenerate;
    }
    return true;
}

SurfaceCurvatures unknown_curvatures(std::size_t count) {
    return {Array<double>(count), Array<double>(count), Array<std::uint8_t>(count), -1};
}

}  // namespace

SurfaceCurvatures curvatures_along(const CurvePieces& coedges, const PiecePlaces& places,
                                   const SharedSurfaces& surfaces) {
    SurfaceCurvatures found = unknown_curvatures(places.fraction.size());
    Array<std::uint8_t> refused(places.which.size());
    for_each_block(places.which.size(), PIECES_AT_ONCE, [&](std::size_t from, std::size_t to) {
        Array<double> t;
        Array<Point3> on_plane;
        Array<Point2> uv;
        SurfaceValues values;
        for (std::size_t i = from; i < to; ++i) {
            parameters_of(coedges, places, i, t);
            on_plane.resize(t.size());
            coedges.curves[static_cast<std::size_t>(places.which[i])]->evaluate(
                t, 0, {on_plane.data(), t.size()});
            uv.clear();
            for (std::size_t k = 0; k < t.size(); ++k)
                uv.push_back({on_plane.data()[k].x, on_plane.data()[k].y});
            refused.data()[i] = !set_curvatures(*surfaces[i], uv, places.start(i), values, found);
        }
    });
    const auto* first = std::find(refused.begin(), refused.end(), 1);
    if (first != refused.end()) found.refused = first - refused.begin();
    return found;
}

SurfaceCurvatures curvatures_at(std::span<const Point2> uv, std::span<const std::int64_t> first,
                                const SharedSurfaces& surfaces) {
    SurfaceCurvatures found = unknown_curvatures(uv.size());
    Array<std::uint8_t> refused(surfaces.size());
    for_each_block(surfaces.size(), PIECES_AT_ONCE, [&](std::size_t from, std::size_t to) {
        SurfaceValues values;
        for (std::size_t i = from; i < to; ++i) {
            const auto start = static_cast<std::size_t>(first[i]);
            const auto count = static_cast<std::size_t>(first[i + 1]) - start;
            refused.data()[i] =
                !set_curvatures(*surfaces[i], uv.subspan(start, count), start, values, found);
        }
    });
    const auto* row = std::find(refused.begin(), refused.end(), 1);
    if (row != refused.end()) found.refused = row - refused.begin();
    return found;
}

}  // namespace surfmesh
