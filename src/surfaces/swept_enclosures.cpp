// Extrusions and surfaces of revolution: how they bend, by how their curves do.
//
// With q = c(v) - o, turned about the axis a, and a direction d of space, two vectors suffice:
//
//     d . r = d . (a . q) a + A cos u + B sin u      A = (d - (d . a) a) . q     B = (d x a) . q
#include <algorithm>
#include <cmath>

#include "surfaces/outward.hpp"
#include "surfaces/swept_surfaces.hpp"
#include "surfaces/swept_waves.hpp"

namespace surfmesh {
namespace {

/// Bounds of a curve by coordinates.
struct CurveSize {
    std::array<double, 3> order{};  // of |c - about|, |c'| and |c''|
    double jump = 0.0;              // of c' at creases, in all
    double known_to = 0.0;          // c itself
};

bool size_along_axes(const Curve& curve, Interval t, Point3 about, CurveSize& size) {
    size = CurveSize{};
    for (const Point3& axis : AXES) {
        CurveAlong c;
        if (!curve.enclose_along(t, axis, about, c)) return false;
        for (std::size_t k = 0; k < 3; ++k) size.order[k] += outward::magnitude(c[k]);
        size.jump += c.jump;
        size.known_to += c[0].hi - c[0].lo;
    }
    return true;
}

/// Of some cells or points the curve may know none; of the surface as a whole it knows them then.
SurfaceStatus known_if(bool any, std::size_t asked) {
    return any || asked == 0 ? SurfaceStatus::DONE : SurfaceStatus::UNKNOWN;
}

/// Of the values of a curve that bounds itself, the round-off as of short sums of its size.
SurfaceStatus enclose_by(const Surface& surface, const Curve& curve, bool along_v, double size,
                         std::span<const Point2> uv, std::span<EnclosedPoint> out) {
    Array<Point3> r(uv.size());
    const auto status = surface.evaluate(uv, 0, r);
    if (status != SurfaceStatus::DONE) return status;
    bool any = false;
    for (std::size_t i = 0; i < uv.size(); ++i) {
        const double t = along_v ? uv[i].y : uv[i].x;
        CurveSize most;
        out[i] = {r[i], intervals::INFINITE};
        if (!size_along_axes(curve, {t, t}, {0.0, 0.0, 0.0}, most)) continue;
        any = true;
        out[i].error =
            SWEPT_ROUNDING * (size + 32.0 * most.order[0] + std::abs(uv[i].y)) +
            8.0 * most.known_to;  // by the margin of Bezier coefficients, of as many sums
    }
    return known_if(any, uv.size());
}

}  // namespace

SurfaceStatus ExtrusionSurface::enclose(std::span<const Point2> uv,
                                        std::span<EnclosedPoint> out) const {
    return enclose_by(*this, *curve_, false, 0.0, uv, out);
}

SurfaceStatus ExtrusionSurface::enclose_bends(std::span<const ParameterBox> cells,
                                              std::span<const Directions> directions,
                                              std::span<Bends> out) const {
    bool any = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        out[i] = Bends{};
        const Interval u{cells[i].low.x, cells[i].high.x};
        for (std::size_t k = 0; k < 3; ++k) {
            CurveAlong c;
            if (!curve_->enclose_along(u, directions[i][k], {0.0, 0.0, 0.0}, c)) {
                out[i] = UNBOUNDED_BENDS;
                break;
            }
            any = true;
            out[i].uu[k] = c[2];
            out[i].jump_u[k] = c.jump;
        }
    }
    return known_if(any, cells.size());
}

SurfaceStatus RevolutionSurface::enclose(std::span<const Point2> uv,
                                         std::span<EnclosedPoint> out) const {
    return enclose_by(*this, *curve_, true, norm_1(origin_), uv, out);
}

/// Along one direction.
bool RevolutionSurface::enclose_along(Interval u, Interval v, Point3 d, const CurveRoundings& off,
                                      BendsAlong& out) const {
    using namespace outward;
    const Point3 along_axis = dot(d, axis_) * axis_;
    CurveAlong a, b, h;
    if (!curve_->enclose_along(v, d - along_axis, origin_, a) ||
        !curve_->enclose_along(v, cross(d, axis_), origin_, b) ||
        !curve_->enclose_along(v, along_axis, origin_, h))
        return false;
    const Interval value = widened_by(wave_of(a[0], b[0], u), off.order[0]);
    out.uu = intervals::negative(value);
    out.uv = widened_by(wave_of(b[1], intervals::negative(a[1]), u), off.order[1]);
    out.vv = widened_by(add(h[2], wave_of(a[2], b[2], u)), off.order[2]);
    out.jump_v = (h.jump + a.jump + b.jump + off.jump) * (1.0 + SWEPT_ROUNDING);
    return true;
}

SurfaceStatus RevolutionSurface::enclose_bends(std::span<const ParameterBox> cells,
                                               std::span<const Directions> directions,
                                               std::span<Bends> out) const {
    bool any = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Interval u{cells[i].low.x, cells[i].high.x}, v{cells[i].low.y, cells[i].high.y};
        CurveSize size;
        out[i] = UNBOUNDED_BENDS;
        if (!size_along_axes(*curve_, v, origin_, size)) continue;
        CurveRoundings off{};  // the vectors are rounded
        for (std::size_t k = 0; k < 3; ++k) off.order[k] = SWEPT_ROUNDING * size.order[k];
        off.jump = SWEPT_ROUNDING * size.jump;
        Bends found{};
        bool all = true;
        for (std::size_t k = 0; k < 3 && all; ++k) {
            BendsAlong along{};
            all = enclose_along(u, v, directions[i][k], off, along);
            found.uu[k] = along.uu;
            found.uv[k] = along.uv;
            found.vv[k] = along.vv;
            found.jump_v[k] = along.jump_v;
        }
        if (all) out[i] = found;
        any = any || all;
    }
    return known_if(any, cells.size());
}

}  // namespace surfmesh
