#include <algorithm>
#include <cmath>
#include <limits>

#include "elementary_functions/power.hpp"
#include "faces/face_mesh.hpp"

namespace surfmesh {
namespace {

constexpr double COARSE = 2.0;  // times longer than the sizes inside allow: they are to be cut

/// Fractions of a segment at which the sizes inside are read. Where sizes have a direction
/// segments may be long, and pass much on their way; else the middle does.
constexpr double ALONG[] = {0.1, 0.3, 0.5, 0.7, 0.9}, MIDDLE[] = {0.5};

/// Length of a segment in space over its metric length there: the size that it passes.
double passed_size(const Background& background, Point2 at, Point2 way, double length) {
    const SizeTensor a = background.metric_root_at(at.x, at.y);
    const double metric =
        elementary::hypot(a.xx * way.x + a.xy * way.y, a.xy * way.x + a.yy * way.y);
    return length / std::max(metric, std::numeric_limits<double>::min());
}

}  // namespace

CoarseSegments coarse_segments(const FaceField& field, const SegmentsInSpace& loops,
                               double min_size, bool is_anisotropic) {
    const std::span<const double> fractions =
        is_anisotropic ? std::span<const double>(ALONG) : std::span<const double>(MIDDLE);
    CoarseSegments found;
    Array<Point2> places;
    for (const auto [start, end] : loops.segments) {
        const Point3 step = loops.points[end] - loops.points[start];
        const double length = norm(step);
        if (!(length > 0.0)) continue;  // at a pole there is none
        const Point2 a = loops.uv[start], b = loops.uv[end];
        const Point2 way =
            is_anisotropic ? field.chart.to_plane(b) - field.chart.to_plane(a) : Point2{0.0, 0.0};
        double inverse = 0.0;
        Point2 uv[std::size(ALONG)];
        double size[std::size(ALONG)];
        for (std::size_t k = 0; k < fractions.size(); ++k) {
            const double t = fractions[k];
            uv[k] = (1.0 - t) * a + t * b;
            const Point2 xy = field.chart.to_plane(uv[k]);
            const double inside = is_anisotropic ? passed_size(field.background, xy, way, length)
                                                 : field.background.scalar_size_at(xy.x, xy.y);
            size[k] = std::max(inside, min_size);
            inverse += 1.0 / size[k];
        }
        if (!(length > COARSE / (inverse / static_cast<double>(fractions.size())))) continue;
        for (std::size_t k = 0; k < fractions.size(); ++k) {
            places.push_back(uv[k]);
            found.sizes.push_back(size[k]);
            found.along.push_back({step.x / length, step.y / length, step.z / length});
        }
    }
    SurfaceValues values;
    if (values.evaluate(field.surface, places, 0) == SurfaceStatus::DONE)
        found.points = Array<Point3>(values[0]);
    return found;
}

}  // namespace surfmesh
