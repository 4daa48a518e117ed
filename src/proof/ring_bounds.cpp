#include "proof/ring_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double RING_ROUNDING = 0x1p-46;   // relative, more than that of any sum here
constexpr double LARGEST_COSINE = -0.5;     // of 120 degrees
constexpr double STEEPEST = 0.766;          // the sine of 50 degrees
constexpr double LARGEST_SHIFT = 0.25;      // of the smallest height
constexpr double STEEPEST_FRAME = 0x1p-20;  // tilt of a normal

/// What is known of a triangle's shape, in numbers that are on the safe side.
struct Shape {
    Point3 normal;
    double tilt;        // by how much the normal may be wrong
    double height;      // the smallest
    double least_sine;  // of its angles
    bool is_good;       // shape and shift are as the statement needs them
};

Shape shape_of(const SpaceCorners& p, const TriangleBounds& bounds) {
    Shape shape{};
    std::array<Point3, 3> side;
    std::array<double, 3> length{};
    for (std::size_t k = 0; k < 3; ++k) {
        side[k] = p[(k + 1) % 3] - p[k];
        length[k] = norm(side[k]);
    }
    const Point3 n = cross(side[0], side[1]);
    const double area = norm(n), longest = std::max({length[0], length[1], length[2]});
    shape.tilt = (32.0 * 0x1p-53 * longest * longest + 8.0 * bounds.corner * longest) / area;
    if (!(shape.tilt < STEEPEST_FRAME)) return shape;
    shape.normal = (1.0 / area) * n;
    shape.height = area / longest * (1.0 - 4.0 * shape.tilt);
    shape.least_sine = 1.0;
    bool is_blunt = false;
    for (std::size_t k = 0; k < 3; ++k) {
        const double product = length[k] * length[(k + 2) % 3];
        const double cosine = -dot(side[k], side[(k + 2) % 3]) / product;
        is_blunt = is_blunt || !(cosine > LARGEST_COSINE + 1e-6);
        shape.least_sine = std::min(shape.least_sine, area / product * (1.0 - 4.0 * shape.tilt));
    }
    shape.is_good = !is_blunt && bounds.shift <= LARGEST_SHIFT * shape.height;
    return shape;
}

struct HalfEdges {
    std::span<const std::int32_t> vertices, twins;

    /// Do both triangles run the same way along their side, as on one-sided surfaces?
    [[nodiscard]] bool run_alike(std::size_t h, std::size_t twin) const {
        return vertices[h] == vertices[twin];
    }
};

/// What the side to a neighbour costs; infinite where the statement does not hold with it.
double cost_of_side(const Shape& own, const Shape& other, const TriangleBounds& bounds,
                    std::size_t k, bool run_alike) {
    if (!other.is_good) return intervals::INFINITE;
    const double sign = run_alike ? -1.0 : 1.0;
    if (!(sign * dot(own.normal, other.normal) > 0.0)) return intervals::INFINITE;
    const double sine =
        norm(cross(own.normal, other.normal)) + own.tilt + other.tilt + RING_ROUNDING;
    if (!(sine < STEEPEST)) return intervals::INFINITE;
    const double cosine = std::sqrt(1.0 - sine * sine) * (1.0 - RING_ROUNDING);
    if (!(bounds.shift <= own.height * other.least_sine * cosine)) return intervals::INFINITE;
    const double over = bounds.height + bounds.outward[k] * (sine / cosine);
    const double under = bounds.height * (1.0 + sine * sine) / cosine + bounds.outward[k] * sine;
    return std::max(over, under) * (1.0 + RING_ROUNDING);
}

}  // namespace

RingBounds ring_bounds(std::span<const SpaceCorners> corners,
                       std::span<const std::int32_t> vertices, std::span<const std::int32_t> twins,
                       std::span<const TriangleBounds> bounds) {
    const std::size_t count = corners.size();
    const HalfEdges half_edges{vertices, twins};
    Array<Shape> shapes(count);
    for (std::size_t t = 0; t < count; ++t) shapes[t] = shape_of(corners[t], bounds[t]);
    RingBounds found{Array<double>(count), Array<std::uint8_t>(count)};
    for (std::size_t t = 0; t < count; ++t) {
        const TriangleBounds& own = bounds[t];
        double most = shapes[t].is_good ? own.height : intervals::INFINITE, corner = own.corner;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t twin = twins[3 * t + k];
            if (twin == NIL) {
                most = std::max(most, own.rim[k]);
                continue;
            }
            const auto other = static_cast<std::size_t>(twin / 3);
            most = std::max(most, cost_of_side(shapes[t], shapes[other], own, k,
                                               half_edges.run_alike(
                                                   3 * t + k, static_cast<std::size_t>(twin))));
            corner = std::max(corner, bounds[other].corner);
        }
        found.by_ring[t] = most <= own.whole ? 1 : 0;
        const double bound = std::min(most, own.whole) + corner;
        found.bound[t] =
            bound <= intervals::INFINITE ? bound * (1.0 + RING_ROUNDING) : intervals::INFINITE;
    }
    return found;
}

}  // namespace surfmesh
