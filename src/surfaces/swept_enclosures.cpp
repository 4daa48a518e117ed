// Extrusions and surfaces of revolution: how they bend, by how their curves do.
//
// With q = c(v) - o, turned about the axis a, and a direction d of space, two vectors suffice:
//
//     d . r = d . (a . q) a + A cos u + B sin u      A = (d - (d . a) a) . q     B = (d x a) . q
#include <algorithm>
#include <cmath>

#include "surfaces/outward.hpp"
#include "surfaces/swept_surfaces.hpp"

namespace surfmesh {
namespace {

constexpr double SWEPT_ROUNDING = 0x1p-46;  // more than any of the sums below, of their terms

double sum_of_sizes(Point3 a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); }

Interval widened_by(Interval a, double margin) { return {a.lo - margin, a.hi + margin}; }

/// a cos u + b sin u for ranges of a and b: linear in these, so extreme at their ends.
Interval wave_of(Interval a, Interval b, Interval u) {
    using outward::hull;
    return hull(hull(wave_range(a.lo, b.lo, u), wave_range(a.lo, b.hi, u)),
                hull(wave_range(a.hi, b.lo, u), wave_range(a.hi, b.hi, u)));
}

/// Bounds of |c - about|, |c'| and |c''|.
bool size_along_axes(const Curve& curve, Interval t, Point3 about, std::array<double, 3>& size) {
    constexpr std::array<Point3, 3> AXES = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    size = {0.0, 0.0, 0.0};
    for (const Point3& axis : AXES) {
        std::array<Interval, 3> c;
        if (!curve.enclose_along(t, axis, about, c)) return false;
        for (std::size_t k = 0; k < 3; ++k) size[k] += outward::magnitude(c[k]);
    }
    return true;
}

/// Of the values of a curve that bounds itself, the round-off as of short sums of its size.
SurfaceStatus enclose_by(const Surface& surface, const Curve& curve, bool along_v, double size,
                         std::span<const Point2> uv, std::span<EnclosedPoint> out) {
    Array<Point3> r(uv.size());
    const auto status = surface.evaluate(uv, 0, {r.data(), r.size()});
    for (std::size_t i = 0; i < uv.size(); ++i) {
        const double t = along_v ? uv[i].y : uv[i].x;
        std::array<double, 3> most;
        if (!size_along_axes(curve, {t, t}, {0.0, 0.0, 0.0}, most)) return SurfaceStatus::UNKNOWN;
        out[i] = {r[i], SWEPT_ROUNDING * (size + 32.0 * most[0] + std::abs(uv[i].y))};
    }
    return status;
}

}  // namespace

SurfaceStatus ExtrusionSurface::enclose(std::span<const Point2> uv,
                                        std::span<EnclosedPoint> out) const {
    return enclose_by(*this, *curve_, false, 0.0, uv, out);
}

SurfaceStatus ExtrusionSurface::enclose_bends(std::span<const ParameterBox> cells,
                                              std::span<const Directions> directions,
                                              std::span<Bends> out) const {
    for (std::size_t i = 0; i < cells.size(); ++i) {
        out[i] = Bends{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::array<Interval, 3> c;
            if (!curve_->enclose_along({cells[i].low.x, cells[i].high.x}, directions[i][k],
                                       {0.0, 0.0, 0.0}, c))
                return SurfaceStatus::UNKNOWN;
            out[i].uu[k] = c[2];
        }
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus RevolutionSurface::enclose(std::span<const Point2> uv,
                                         std::span<EnclosedPoint> out) const {
    return enclose_by(*this, *curve_, true, sum_of_sizes(origin_), uv, out);
}

SurfaceStatus RevolutionSurface::enclose_bends(std::span<const ParameterBox> cells,
                                               std::span<const Directions> directions,
                                               std::span<Bends> out) const {
    using namespace outward;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Interval u{cells[i].low.x, cells[i].high.x}, v{cells[i].low.y, cells[i].high.y};
        std::array<double, 3> size;
        if (!size_along_axes(*curve_, v, origin_, size)) return SurfaceStatus::UNKNOWN;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3& d = directions[i][k];
            const Point3 along_axis = dot(d, axis_) * axis_;
            std::array<Interval, 3> a, b, h;
            if (!curve_->enclose_along(v, d - along_axis, origin_, a) ||
                !curve_->enclose_along(v, cross(d, axis_), origin_, b) ||
                !curve_->enclose_along(v, along_axis, origin_, h))
                return SurfaceStatus::UNKNOWN;
            const auto margin = [&](std::size_t order) {  // the vectors are rounded
                return SWEPT_ROUNDING * size[order];
            };
            const Interval value = widened_by(wave_of(a[0], b[0], u), margin(0));
            out[i].uu[k] = intervals::negative(value);
            out[i].uv[k] = widened_by(wave_of(b[1], intervals::negative(a[1]), u), margin(1));
            out[i].vv[k] = widened_by(add(h[2], wave_of(a[2], b[2], u)), margin(2));
        }
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
