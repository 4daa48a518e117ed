#include "proof/side_rates.hpp"

#include <algorithm>
#include <cmath>

#include "surfaces/outward.hpp"
#include "values/array.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t PARTS_OF_SIDE = 4;   // of a side
constexpr double RATE_ROUNDING = 0x1p-30;  // relative: directions are as exact as the side is long

/// The side's direction, and two across it.
Directions directions_of(Point3 side) {
    const double length = norm(side);
    if (!(length > 0.0)) return {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    const Point3 e = (1.0 / length) * side;
    const double x = std::abs(e.x), y = std::abs(e.y), z = std::abs(e.z);
    const Point3 other = x <= y && x <= z ? Point3{1.0, 0.0, 0.0}
                         : y <= z         ? Point3{0.0, 1.0, 0.0}
                                          : Point3{0.0, 0.0, 1.0};
    const Point3 across = cross(e, other), first = (1.0 / norm(across)) * across;
    return {e, first, cross(e, first)};
}

ParameterBox box_between(Point2 a, Point2 b) {
    return {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
}

/// The largest |d . r''(w, w)| over a part.
double bend_along(const Bends& bends, std::size_t d, Point2 w) {
    using namespace outward;
    const Interval u = outward::exactly(w.x), v = outward::exactly(w.y);
    const Interval mixed = multiply(multiply(u, v), bends.uv[d]);
    return magnitude(add(add(multiply(multiply(u, u), bends.uu[d]), add(mixed, mixed)),
                         multiply(multiply(v, v), bends.vv[d])));
}

SideRate rate_of(std::span<const Bends> parts, Point2 w, double length) {
    std::array<double, 3> most{};
    for (std::size_t d = 0; d < 3; ++d) {
        double jumps = 0.0;
        for (const Bends& bends : parts) {
            most[d] = std::max(most[d], 0.5 * bend_along(bends, d, w));
            jumps += std::abs(w.x) * bends.jump_u[d] + std::abs(w.y) * bends.jump_v[d];
        }
        most[d] = (most[d] + jumps) / length * (1.0 + RATE_ROUNDING);
        if (!(most[d] < intervals::INFINITE)) return {intervals::INFINITE, intervals::INFINITE};
    }
    const double all = std::sqrt(most[0] * most[0] + most[1] * most[1] + most[2] * most[2]);
    return {most[0] + RATE_ROUNDING * all,
            std::sqrt(most[1] * most[1] + most[2] * most[2]) + RATE_ROUNDING * all};
}

}  // namespace

SurfaceStatus side_rates(const Surface& surface, std::span<const std::array<Point3, 2>> ends,
                         std::span<const std::array<Point2, 2>> uv, std::span<SideRate> out) {
    Array<ParameterBox> boxes;
    Array<Directions> directions;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const Directions along = directions_of(ends[i][1] - ends[i][0]);
        const auto [a, b] = uv[i];
        for (std::size_t k = 0; k < PARTS_OF_SIDE; ++k) {
            const auto at = [&](std::size_t n) {
                const double t = static_cast<double>(n) / static_cast<double>(PARTS_OF_SIDE);
                return n == PARTS_OF_SIDE ? b : (1.0 - t) * a + t * b;
            };
            boxes.push_back(box_between(at(k), at(k + 1)));
            directions.push_back(along);
        }
    }
    Array<Bends> bends(boxes.size());
    const auto status =
        surface.enclose_bends({boxes.data(), boxes.size()}, {directions.data(), directions.size()},
                              {bends.data(), bends.size()});
    if (status == SurfaceStatus::FAILED) return status;
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = {intervals::INFINITE, intervals::INFINITE};
        const double length = norm(ends[i][1] - ends[i][0]);
        if (status == SurfaceStatus::DONE && length > 0.0)
            out[i] = rate_of({bends.data() + PARTS_OF_SIDE * i, PARTS_OF_SIDE}, uv[i][1] - uv[i][0],
                             length);
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
