#include "surfaces/elementary_surfaces.hpp"

#include <algorithm>

#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t POINTS_AT_ONCE = 128;  // points whose sines are computed at a time

/// Sines and cosines of a chunk of parameters.
struct Turns {
    std::array<double, POINTS_AT_ONCE> sine, cosine;

    void compute(const std::array<double, POINTS_AT_ONCE>& angle, std::size_t count) {
        elementary::sincos({angle.data(), count}, {sine.data(), count}, {cosine.data(), count});
    }
};

/// The derivatives 0 to 3 of p or h at a v.
using ProfileDerivatives = std::array<double, 4>;

struct PointOfProfile {
    ProfileDerivatives p, h;
};

PointOfProfile point_of_line(const Profile& line, double v) {
    return {{line.radius + line.outwards * v, line.outwards, 0.0, 0.0},
            {line.upwards * v, line.upwards, 0.0, 0.0}};
}

PointOfProfile point_of_circle(const Profile& circle, double cosine, double sine) {
    const double c = circle.tube * cosine, s = circle.tube * sine;
    return {{circle.radius + c, -s, -c, s}, {s, c, -s, -c}};
}

}  // namespace

Profile profile_of_cone(double radius, double angle) {
    const auto [sine, cosine] = elementary::sincos(angle);
    return {radius, sine, cosine, 0.0, false};
}

SurfaceStatus Plane::evaluate(std::span<const Point2> uv, int order, std::span<Point3> out) const {
    const std::size_t count = uv.size();
    for (std::size_t i = 0; i < count; ++i)
        out[i] = frame_.origin + uv[i].x * frame_.x + uv[i].y * frame_.y;
    for (std::size_t number = 1; number < derivative_count(order); ++number) {
        const Point3 value = number == 1   ? frame_.x
                             : number == 2 ? frame_.y
                                           : Point3{0.0, 0.0, 0.0};
        std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(number * count), count, value);
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus TurnedProfile::evaluate(std::span<const Point2> uv, int order,
                                      std::span<Point3> out) const {
    const std::size_t derivatives = derivative_count(order);
    const auto& [origin, x, y, z] = frame_;
    std::array<double, POINTS_AT_ONCE> angle;
    Turns u, v;
    for (std::size_t start = 0; start < uv.size(); start += POINTS_AT_ONCE) {
        const std::size_t count = std::min(POINTS_AT_ONCE, uv.size() - start);
        for (std::size_t i = 0; i < count; ++i) angle[i] = uv[start + i].x;
        u.compute(angle, count);
        if (profile_.is_circle) {
            for (std::size_t i = 0; i < count; ++i) angle[i] = uv[start + i].y;
            v.compute(angle, count);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const auto [p, h] = profile_.is_circle
                                    ? point_of_circle(profile_, v.cosine[i], v.sine[i])
                                    : point_of_line(profile_, uv[start + i].y);
            const Point3 e = u.cosine[i] * x + u.sine[i] * y;
            const Point3 across = u.cosine[i] * y - u.sine[i] * x;  // e', and e'' = -e
            Point3* to = out.data() + start + i;
            to[0] = origin + (p[0] * e + h[0] * z);
            for (std::size_t number = 1; number < derivatives; ++number) {
                const auto [k, l] = DERIVATIVES[number];
                const double sign = k > 1 ? -1.0 : 1.0;
                const Point3 turned = (sign * p[l]) * (k % 2 == 0 ? e : across);
                to[number * uv.size()] = k == 0 ? turned + h[l] * z : turned;
            }
        }
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
