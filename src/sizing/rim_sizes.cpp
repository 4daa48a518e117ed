#include "sizing/rim_sizes.hpp"

#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

bool is_finite(Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

RimSize rim_size(const SurfaceReader& r, std::size_t i, Point2 step, double chord) {
    const double du = step.x, dv = step.y;
    const Point3 first = du * r[1][i] + dv * r[2][i];
    const Point3 second = du * du * r[3][i] + 2.0 * du * dv * r[4][i] + dv * dv * r[5][i];
    const double speed = norm(first);
    const double curvature = norm(cross(first, second)) / (speed * speed * speed);
    const Point3 tangent = {first.x / speed, first.y / speed, first.z / speed};
    if (!std::isfinite(curvature) || !is_finite(tangent))
        return {std::numeric_limits<double>::infinity(), {0.0, 0.0, 0.0}};
    const double size = std::sqrt(8.0 * RIM_RESERVE * chord / curvature), least = LEAST_RIM * chord;
    return {size > least ? size : least, tangent};
}

}  // namespace surfmesh
