// Bounds of a curve on a surface along a vector, by those of both over a box of (u, v).
//
// d . r_u over the box is within its changes of d . (r(u1, v) - r(u0, v)) / (u1 - u0), which it is
// somewhere: between u0 and u1, which are at least a part of the domain apart.
#include <algorithm>
#include <cmath>

#include "surfaces/curve_on_surface.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr double LEAST_WIDTH = 0x1p-10;  // of the domain: differences of points are far above noise
constexpr double LENGTH_OFF = 0x1p-48;  // relative: more than a direction's length and sums are off

Interval off_by(double margin) { return {-margin, margin}; }

Interval scaled(Interval a, double factor) {
    return outward::multiply(a, outward::exactly(factor));
}

/// A range that is as wide as differences need, within the domain where that lets it.
Interval widened_within(Interval range, double low, double high) {
    const double least = LEAST_WIDTH * (high - low), lacks = least - (range.hi - range.lo);
    if (!(lacks > 0.0)) return range;
    if (range.hi + lacks <= high) return {range.lo, range.hi + lacks};
    return {std::min(range.lo, high - least), range.hi};
}

/// What a surface does along one direction over a box.
struct SurfaceAlong {
    Interval value, u, v, uu, uv, vv;
    double jump_u, jump_v;
};

/// d . r of a point, about another.
Interval value_along(const EnclosedPoint& found, Point3 d, Point3 about) {
    const Point3 x = found.value - about;
    const double sizes = norm(found.value) + norm(about);
    const double off = 2.0 * found.error + LENGTH_OFF * sizes;
    return outward::add(outward::exactly(dot(d, x)), off_by(off));
}

bool enclose_surface(const Surface& surface, Interval u, Interval v, Point3 d, Point3 about,
                     SurfaceAlong& out) {
    using namespace outward;
    const auto& [low, high] = surface.domain();
    const Interval wide_u = widened_within(u, low.x, high.x),
                   wide_v = widened_within(v, low.y, high.y);
    const ParameterBox box{{wide_u.lo, wide_v.lo}, {wide_u.hi, wide_v.hi}};
    const Directions directions{d, d, d};
    Bends bends;
    if (surface.enclose_bends({&box, 1}, {&directions, 1}, {&bends, 1}) != SurfaceStatus::DONE)
        return false;
    const double middle_u = 0.5 * (u.lo + u.hi), middle_v = 0.5 * (v.lo + v.hi);
    const std::array<Point2, 5> places = {{{wide_u.lo, middle_v},
                                           {wide_u.hi, middle_v},
                                           {middle_u, wide_v.lo},
                                           {middle_u, wide_v.hi},
                                           {middle_u, middle_v}}};
    std::array<EnclosedPoint, 5> points{};
    if (surface.enclose(places, points) != SurfaceStatus::DONE) return false;
    std::array<Interval, 5> at{};
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = value_along(points[k], d, about);
    const Interval width_u = subtract(exactly(wide_u.hi), exactly(wide_u.lo)),
                   width_v = subtract(exactly(wide_v.hi), exactly(wide_v.lo));
    if (!(width_u.lo > 0.0 && width_v.lo > 0.0)) return false;
    const double mixed = magnitude(bends.uv[0]);
    const double change_u =
        above(above(width_u.hi * magnitude(bends.uu[0])) + above(width_v.hi * mixed)) +
        bends.jump_u[0];
    const double change_v =
        above(above(width_v.hi * magnitude(bends.vv[0])) + above(width_u.hi * mixed)) +
        bends.jump_v[0];
    out = {at[4],
           add(divide(subtract(at[1], at[0]), width_u), off_by(above(change_u))),
           add(divide(subtract(at[3], at[2]), width_v), off_by(above(change_v))),
           bends.uu[0],
           bends.uv[0],
           bends.vv[0],
           bends.jump_u[0],
           bends.jump_v[0]};
    const double reach =
        above(above((u.hi - u.lo) * magnitude(out.u)) + above((v.hi - v.lo) * magnitude(out.v)));
    out.value = add(out.value, off_by(above(reach)));
    return reach < intervals::INFINITE;
}

}  // namespace

bool CurveOnSurface::enclose_along(Interval t, Point3 w, Point3 about, CurveAlong& out) const {
    using namespace outward;
    const double length = norm(w);
    if (!(length > 0.0)) {
        out = {{exactly(0.0), exactly(0.0), exactly(0.0)}};
        return length == 0.0;
    }
    const Interval own = add(exactly(shift_), multiply(exactly(rate_), t));
    CurveAlong u, v;
    if (!pcurve_->enclose_along(own, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, u) ||
        !pcurve_->enclose_along(own, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}, v))
        return false;
    SurfaceAlong r{};
    if (!enclose_surface(*surface_, u[0], v[0], (1.0 / length) * w, about, r)) return false;
    const Interval du = scaled(u[1], rate_), dv = scaled(v[1], rate_);
    const Interval d2u = scaled(scaled(u[2], rate_), rate_),
                   d2v = scaled(scaled(v[2], rate_), rate_);
    const Interval mixed = multiply(multiply(du, dv), r.uv);
    const Interval bent =
        add(add(multiply(rounded(intervals::integer_power(du, 2)), r.uu), add(mixed, mixed)),
            multiply(rounded(intervals::integer_power(dv, 2)), r.vv));
    const Interval first = add(multiply(du, r.u), multiply(dv, r.v));
    const Interval second = add(bent, add(multiply(d2u, r.u), multiply(d2v, r.v)));
    const double longer = length * (1.0 + LENGTH_OFF);
    out.order = {r.value, first, second};
    for (Interval& range : out.order) {
        const double off = LENGTH_OFF * magnitude(range);
        range = scaled(add(range, off_by(off)), length);
    }
    const double rate = std::abs(rate_);
    out.jump = longer *
               (rate * (u.jump * magnitude(r.u) + v.jump * magnitude(r.v)) +
                magnitude(du) * r.jump_u + magnitude(dv) * r.jump_v) *
               (1.0 + LENGTH_OFF);
    return true;
}

}  // namespace surfmesh
