#include "proof/curve_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr double CURVE_ROUNDING = 0x1p-46;  // relative, more than that of any sum here
double root_of_squares(const std::array<double, 3>& x) {
    return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) * (1.0 + CURVE_ROUNDING);
}

struct CurvePoint {
    Point3 value;
    double error;
};

/// c(t) about a point, and how far that is off at most.
CurvePoint point_at(const Curve& curve, double t, Point3 about) {
    std::array<double, 3> middle{}, off{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        CurveAlong c;
        if (!curve.enclose_along({t, t}, AXES[axis], about, c)) return {about, intervals::INFINITE};
        middle[axis] = 0.5 * (c[0].lo + c[0].hi);
        off[axis] = c[0].hi - c[0].lo;  // half of it, and as much for the rounding of the middle
    }
    return {{middle[0], middle[1], middle[2]}, root_of_squares(off)};
}

/// From the segment between the origin and ``end``.
double distance_to_segment(Point3 x, Point3 end) {
    const double length = dot(end, end);
    const double t = length > 0.0 ? std::clamp(dot(x, end) / length, 0.0, 1.0) : 0.0;
    return norm(x - t * end) + CURVE_ROUNDING * (norm(x) + norm(end));
}

/// How far a part of the curve is from its chord at most: a quarter of dt times the largest jump of
/// c' at creases, and an eighth of dt^2 times the largest |c''|.
double sag_of(const Curve& curve, double first, double last, double step) {
    std::array<double, 3> bend{}, jump{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        CurveAlong c;
        if (!curve.enclose_along({first, last}, AXES[axis], {0.0, 0.0, 0.0}, c))
            return intervals::INFINITE;
        bend[axis] = outward::magnitude(c[2]);
        jump[axis] = c.jump;
    }
    if (step == 0.0) return 0.0;
    return 0.125 * (step * step) * root_of_squares(bend) +
           0.25 * std::abs(step) * root_of_squares(jump);
}

/// How far a part of the curve is at most from the segment between the origin and ``end``, by its
/// ranges along the segment and across it: of use where c'' is large for what it does, as over the
/// many spans of an approximation.
double distance_by_ranges(const Curve& curve, double first, double last, Point3 start, Point3 end) {
    const double length = norm(end);
    if (!(length > 0.0)) return intervals::INFINITE;
    const Point3 e = (1.0 / length) * end;
    const Point3& apart = std::abs(e.x) < 0.6 ? AXES[0] : AXES[1];
    const Point3 across = cross(e, apart), x = (1.0 / norm(across)) * across, y = cross(e, x);
    std::array<double, 3> off{};
    double size = length;
    for (std::size_t k = 0; k < 3; ++k) {
        CurveAlong c;
        if (!curve.enclose_along({first, last}, k == 0 ? x : k == 1 ? y : e, start, c))
            return intervals::INFINITE;
        off[k] = k < 2 ? outward::magnitude(c[0]) : std::max({-c[0].lo, c[0].hi - length, 0.0});
        size += outward::magnitude(c[0]);
    }
    return root_of_squares(off) + CURVE_ROUNDING * size;
}

/// Over all parts, between the same parameters as their ends are.
double farthest_by_ranges(const Curve& curve, const ParameterEnds& t, int parts, Point3 start,
                          Point3 end) {
    const double step = (t[1] - t[0]) / parts;
    double most = 0.0, from = t[0];
    for (int part = 1; part <= parts; ++part) {
        const double to = part == parts ? t[1] : t[0] + step * part;
        const double there =
            distance_by_ranges(curve, std::min(from, to), std::max(from, to), start, end);
        most = std::max(most, there <= intervals::INFINITE ? there : intervals::INFINITE);
        from = to;
    }
    return most;
}

}  // namespace

Array<double> curve_bounds(const Curve& curve, std::span<const ParameterEnds> t,
                           std::span<const SegmentEnds> ends, int parts) {
    Array<double> found(t.size());
    for (std::size_t i = 0; i < t.size(); ++i) {
        const Point3 start = ends[i][0], end = ends[i][1] - start;
        const double step = (t[i][1] - t[i][0]) / parts;
        double most = 0.0, off = 0.0;
        for (int part = 0; part <= parts; ++part) {
            const double to = part == parts ? t[i][1] : t[i][0] + step * part;
            const auto [x, error] = point_at(curve, to, start);
            if (part == 0) off = norm(x) + error;
            if (part == parts) off = std::max(off, norm(x - end) + error);
            most = std::max(most, distance_to_segment(x, end) + error);
        }
        const double sag =
            sag_of(curve, std::min(t[i][0], t[i][1]), std::max(t[i][0], t[i][1]), step);
        double within = most + sag * (1.0 + CURVE_ROUNDING);
        if (sag > most)
            within = std::min(within, farthest_by_ranges(curve, t[i], parts, start, end));
        const double bound = (within + off) * (1.0 + CURVE_ROUNDING);
        found[i] = bound <= intervals::INFINITE ? bound : intervals::INFINITE;
    }
    return found;
}

}  // namespace surfmesh
