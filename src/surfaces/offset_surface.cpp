#include "surfaces/offset_surface.hpp"

#include <algorithm>

namespace surfmesh {
namespace {

// |N| over the squared longer tangent, both per domain: poles
constexpr double DEGENERATE_NORMAL = 1e-10;
constexpr double POLE_NUDGE = 1e-4;  // of the domain: second derivatives of n keep half their
                                     // digits there

/// A vector field over (u, v) at a point, with its derivatives as far as they are asked for.
struct Field {
    Point3 value, u, v, uu, uv, vv;
};

Point3 divided(Point3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }

/// N = r_u x r_v and its derivatives, from the ten derivatives of r to the third order.
Field normal_field(const std::array<Point3, 10>& r, int order) {
    Field N{};
    N.value = cross(r[1], r[2]);
    if (order > 0) {
        N.u = cross(r[3], r[2]) + cross(r[1], r[4]);
        N.v = cross(r[4], r[2]) + cross(r[1], r[5]);
    }
    if (order > 1) {  // r_uv x r_uv = 0
        N.uu = cross(r[6], r[2]) + 2.0 * cross(r[3], r[4]) + cross(r[1], r[7]);
        N.uv = cross(r[7], r[2]) + cross(r[3], r[5]) + cross(r[1], r[8]);
        N.vv = cross(r[8], r[2]) + 2.0 * cross(r[4], r[5]) + cross(r[1], r[9]);
    }
    return N;
}

/// n = N / |N| and its derivatives; zero at poles.
Field unit_field(const Field& N, int order) {
    const double length = norm(N.value), s = length > 0.0 ? length : 1.0;
    Field n{};
    n.value = divided(N.value, s);
    if (order == 0) return n;
    const double s_u = dot(n.value, N.u), s_v = dot(n.value, N.v);
    n.u = divided(N.u - s_u * n.value, s);
    n.v = divided(N.v - s_v * n.value, s);
    if (order == 1) return n;
    const double s_uu = dot(n.u, N.u) + dot(n.value, N.uu);
    const double s_uv = dot(n.v, N.u) + dot(n.value, N.uv);
    const double s_vv = dot(n.v, N.v) + dot(n.value, N.vv);
    n.uu = divided(N.uu - s_uu * n.value - 2.0 * s_u * n.u, s);
    n.uv = divided(N.uv - s_uv * n.value - s_u * n.v - s_v * n.u, s);
    n.vv = divided(N.vv - s_vv * n.value - 2.0 * s_v * n.v, s);
    return n;
}

constexpr std::array<Point3 Field::*, 6> IN_SEQUENCE = {&Field::value, &Field::u,  &Field::v,
                                                        &Field::uu,    &Field::uv, &Field::vv};

}  // namespace

bool OffsetSurface::is_pole(Point3 r_u, Point3 r_v) const {
    const Point2 wide = domain_.high - domain_.low;
    const Point3 a = wide.x * r_u, b = wide.y * r_v;
    return !(norm(cross(a, b)) > DEGENERATE_NORMAL * std::max(dot(a, a), dot(b, b)));
}

/// At one pole; out: derivative_count(order) values.
SurfaceStatus OffsetSurface::evaluate_at_pole(Point2 uv, int order, std::span<Point3> out) const {
    const Point2 wide = domain_.high - domain_.low;
    const Point2 middle = 0.5 * (domain_.low + domain_.high);
    const Point2 inwards = {uv.x > middle.x ? -wide.x : wide.x, uv.y > middle.y ? -wide.y : wide.y};
    std::array<Point3, 10> r{};
    if (const auto status = basis_->evaluate({&uv, 1}, 3, r); status != SurfaceStatus::DONE)
        return status;
    const Field N = normal_field(r, 2);
    Point3 normal = inwards.x * N.u + inwards.y * N.v;
    const Point3 second = inwards.x * inwards.x * N.uu + 2.0 * inwards.x * inwards.y * N.uv +
                          inwards.y * inwards.y * N.vv;
    const bool vanishes =
        !(dot(normal, normal) > DEGENERATE_NORMAL * DEGENERATE_NORMAL * dot(second, second));
    if (vanishes) normal = second;
    const double length = norm(normal);
    const Point3 r_at_pole = r[0] + divided(distance_ * normal, length > 0.0 ? length : 1.0);
    if (order > 0) {
        const Point2 inside = uv + POLE_NUDGE * inwards;
        const auto needed = std::span(r).first(derivative_count(order + 1));
        if (const auto status = basis_->evaluate({&inside, 1}, order + 1, needed);
            status != SurfaceStatus::DONE)
            return status;
        const Field n = unit_field(normal_field(r, order), order);
        for (std::size_t number = 1; number < out.size(); ++number)
            out[number] = r[number] + distance_ * n.*IN_SEQUENCE[number];
    }
    out[0] = r_at_pole;
    return SurfaceStatus::DONE;
}

SurfaceStatus OffsetSurface::evaluate(std::span<const Point2> uv, int order,
                                      std::span<Point3> out) const {
    if (order > 2) return SurfaceStatus::UNKNOWN;
    const std::size_t count = uv.size(), asked = derivative_count(order);
    SurfaceValues basis;
    if (const auto status = basis.evaluate(*basis_, uv, order + 1); status != SurfaceStatus::DONE)
        return status;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<Point3, 10> r{};
        for (std::size_t number = 0; number < derivative_count(order + 1); ++number)
            r[number] = basis[number][i];
        std::array<Point3, 6> found{};
        if (is_pole(r[1], r[2])) {
            if (const auto status = evaluate_at_pole(uv[i], order, std::span(found).first(asked));
                status != SurfaceStatus::DONE)
                return status;
        } else {
            const Field n = unit_field(normal_field(r, order), order);
            for (std::size_t number = 0; number < asked; ++number)
                found[number] = r[number] + distance_ * n.*IN_SEQUENCE[number];
        }
        for (std::size_t number = 0; number < asked; ++number)
            out[number * count + i] = found[number];
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
