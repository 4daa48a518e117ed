// Planes, and lines and circles that are turned: how they bend, in closed form.
//
// Along a direction d the circle e(u) is the wave W(u) = d.x cos u + d.y sin u, with W' and
// W'' = -W, and a surface p(v) e(u) + h(v) z bends by
//
//     d . r_uu = -p W      d . r_uv = p' W'      d . r_vv = p'' W + h'' d.z
#include <algorithm>

#include "surfaces/elementary_surfaces.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr double ELEMENTARY_ROUNDING =
    0x1p-48;  // more than any of the short sums below, of their terms

double largest_of(Point3 a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

Interval wider_by(Interval a, double margin) { return {a.lo - margin, a.hi + margin}; }

/// The range of a line or circle's p, and of p', over a v.
struct ProfileRange {
    Interval p, slope;
};

ProfileRange range_of(const Profile& profile, Interval v) {
    using namespace outward;
    if (!profile.is_circle) {
        const Interval slope = exactly(profile.outwards);
        return {add(exactly(profile.radius), multiply(slope, v)), slope};
    }
    return {add(exactly(profile.radius), wave_range(profile.tube, 0.0, v)),
            wave_range(0.0, -profile.tube, v)};
}

}  // namespace

SurfaceStatus Plane::enclose(std::span<const Point2> uv, std::span<EnclosedPoint> out) const {
    const double origin = largest_of(frame_.origin), x = largest_of(frame_.x),
                 y = largest_of(frame_.y);
    for (std::size_t i = 0; i < uv.size(); ++i) {
        const Point3 r = frame_.origin + uv[i].x * frame_.x + uv[i].y * frame_.y;
        const double size = origin + std::abs(uv[i].x) * x + std::abs(uv[i].y) * y;
        out[i] = {r, ELEMENTARY_ROUNDING * size};
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus Plane::enclose_bends(std::span<const ParameterBox> cells, std::span<const Directions>,
                                   std::span<Bends> out) const {
    std::fill_n(out.begin(), cells.size(), Bends{});
    return SurfaceStatus::DONE;
}

SurfaceStatus TurnedProfile::enclose(std::span<const Point2> uv,
                                     std::span<EnclosedPoint> out) const {
    Array<Point3> r(uv.size());
    const auto status = evaluate(uv, 0, r);
    const double origin = largest_of(frame_.origin);
    const double across = largest_of(frame_.x) + largest_of(frame_.y),
                 along_axis = largest_of(frame_.z);
    const auto& [radius, outwards, upwards, tube, is_circle] = profile_;
    for (std::size_t i = 0; i < uv.size(); ++i) {
        const double v = is_circle ? std::abs(tube) : std::abs(uv[i].y);
        const double p = std::abs(radius) + v * (is_circle ? 1.0 : std::abs(outwards));
        const double h = v * (is_circle ? 1.0 : std::abs(upwards));
        out[i] = {r[i], ELEMENTARY_ROUNDING * (origin + p * across + h * along_axis)};
    }
    return status;
}

SurfaceStatus TurnedProfile::enclose_bends(std::span<const ParameterBox> cells,
                                           std::span<const Directions> directions,
                                           std::span<Bends> out) const {
    using namespace outward;
    const double margin =
        ELEMENTARY_ROUNDING * (largest_of(frame_.x) + largest_of(frame_.y) + largest_of(frame_.z));
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Interval u{cells[i].low.x, cells[i].high.x}, v{cells[i].low.y, cells[i].high.y};
        const auto [p, slope] = range_of(profile_, v);
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3& d = directions[i][k];
            const double x = dot(d, frame_.x), y = dot(d, frame_.y), z = dot(d, frame_.z);
            const Interval wave = wider_by(wave_range(x, y, u), margin);
            const Interval wave_slope = wider_by(wave_range(y, -x, u), margin);
            out[i].uu[k] = intervals::negative(multiply(p, wave));
            out[i].uv[k] = multiply(slope, wave_slope);
            out[i].vv[k] = exactly(0.0);
            if (!profile_.is_circle) continue;
            const double tube = profile_.tube;  // linear in the wave: extreme at its ends
            const Interval both = hull(wave_range(-tube * wave.lo, -tube * z, v),
                                       wave_range(-tube * wave.hi, -tube * z, v));
            out[i].vv[k] = wider_by(both, 2.0 * std::abs(tube) * margin);
        }
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
