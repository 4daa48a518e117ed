#include "proof/ring_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double RING_ROUNDING = 0x1p-46;   // relative, more than that of any sum here
constexpr double STEEPEST = 0.766;          // the sine of 50 degrees
constexpr double STEEPEST_FRAME = 0x1p-20;  // tilt of a normal
constexpr double LITTLE_LOWER = 0x1p-6;     // of the height: not worth it within the limit
constexpr double CERTAIN = 1.0 - 1e-5;  // lengths are less sure than that by far, with such tilts

/// What is known of a triangle's shape, in numbers that are on the safe side.
struct Shape {
    Point3 normal;
    double tilt;  // by how much the normal may be wrong
    // of side k, from corner k on: its length, the height of the third corner over it, and how far
    // along it that lies
    std::array<double, 3> length, height, foot;
    bool is_known;
};

Shape shape_of(const SpaceCorners& p, const TriangleBounds& bounds) {
    Shape shape{};
    std::array<Point3, 3> side;
    for (std::size_t k = 0; k < 3; ++k) {
        side[k] = p[(k + 1) % 3] - p[k];
        shape.length[k] = norm(side[k]);
    }
    const Point3 n = cross(side[0], side[1]);
    const double area = norm(n);
    const double longest = std::max({shape.length[0], shape.length[1], shape.length[2]});
    shape.tilt = (32.0 * 0x1p-53 * longest * longest + 8.0 * bounds.corner * longest) / area;
    if (!(shape.tilt < STEEPEST_FRAME)) return shape;
    shape.is_known = true;
    shape.normal = (1.0 / area) * n;
    for (std::size_t k = 0; k < 3; ++k) {
        shape.height[k] = area / shape.length[k] * CERTAIN;
        shape.foot[k] = -dot(side[(k + 2) % 3], side[k]) / shape.length[k];
    }
    return shape;
}

/// Of triangles, when they are asked for.
class Shapes {
  public:
    Shapes(std::span<const SpaceCorners> corners, std::span<const TriangleBounds> bounds)
        : corners_(corners),
          bounds_(bounds),
          shapes_(Array<Shape>::unfilled(corners.size())),
          is_made_(corners.size(), 0) {}

    const Shape& at(std::size_t t) {
        const auto row = static_cast<std::ptrdiff_t>(t);
        if (is_made_[row] == 0) shapes_[row] = shape_of(corners_[t], bounds_[t]);
        is_made_[row] = 1;
        return shapes_[row];
    }

  private:
    std::span<const SpaceCorners> corners_;
    std::span<const TriangleBounds> bounds_;
    Array<Shape> shapes_;
    Array<std::uint8_t> is_made_;
};

/// A triangle at one of its sides.
struct Side {
    const Shape& shape;
    const TriangleBounds& bounds;
    std::size_t k;

    [[nodiscard]] double height() const { return shape.height[k]; }
    [[nodiscard]] double outward() const { return bounds.outward[k]; }
    /// How far along the side the third corner lies, from one end or the other.
    [[nodiscard]] double foot(bool from_start) const {
        return from_start ? shape.foot[k] : shape.length[k] - shape.foot[k];
    }
    /// Height of the piece where its foot is beyond the side, or inside by no more than that.
    [[nodiscard]] double height_beside(double inside) const {
        return std::min(bounds.height, bounds.beside[k] + bounds.steep[k] * inside);
    }
};

/// Where the piece's foot is beyond the side, l_b from its start a at least this far along:
///
///     l_b (|ab| - rho |ac| cos- - S - rho S')     rho: l_c <= l_a l_b rho there
///
/// with S of the side itself and S' of the others, along it. Without the l_b; l_a, and the angle at
/// the other end, for the distance from b.
double along(const Side& side, bool from_start) {
    const double moved = 4.0 * side.outward();
    const double reserve = side.height() - std::max(moved, side.bounds.inner[side.k]);
    if (!(reserve > 0.0)) return -intervals::INFINITE;
    const double rho = moved / reserve, back = std::max(0.0, -side.foot(from_start));
    return side.shape.length[side.k] * CERTAIN - side.bounds.along[side.k] -
           rho * (back + side.bounds.others[side.k]);
}

/// What a rim costs; infinite where the feet beyond it may lie beyond its ends.
double cost_of_rim(const Side& own) {
    const bool ends = along(own, true) >= 0.0 && along(own, false) >= 0.0;
    return ends ? own.bounds.rim[own.k] : intervals::INFINITE;
}

/// Do feet beyond the side lie over the neighbour? Beyond by o <= l_b 4 s, they are within its
/// angle A at a where they are o cot A along the side.
bool are_over(const Side& own, const Side& other, double cosine, bool run_alike) {
    const double apex = other.height() * cosine;
    for (const bool from_start : {true, false}) {
        const double beside = std::max(0.0, other.foot(from_start == run_alike));
        if (!(along(own, from_start) >= 4.0 * own.outward() * beside / apex / CERTAIN))
            return false;
    }
    return true;
}

/// What the side to a neighbour costs; infinite where the statement does not hold with it.
double cost_of_side(const Side& own, const Side& other, bool run_alike) {
    if (!other.shape.is_known) return intervals::INFINITE;
    const Point3 &n = own.shape.normal, &m = other.shape.normal;
    if (!((run_alike ? -1.0 : 1.0) * dot(n, m) > 0.0)) return intervals::INFINITE;
    const double sine = norm(cross(n, m)) + own.shape.tilt + other.shape.tilt + RING_ROUNDING;
    if (!(sine < STEEPEST)) return intervals::INFINITE;
    const double cosine = std::sqrt(1.0 - sine * sine) * (1.0 - RING_ROUNDING),
                 tangent = sine / cosine;
    // seen along n, the curves over the neighbour's other sides stay beyond this one
    if (!(other.bounds.inner[other.k] + other.bounds.bend * tangent <= other.height()))
        return intervals::INFINITE;
    if (!are_over(own, other, cosine, run_alike)) return intervals::INFINITE;
    const double over = own.height_beside(0.0) + own.outward() * tangent;
    const double high = other.height_beside(other.bounds.height * tangent);
    const double under = std::max(high / cosine, high * cosine + other.outward() * sine);
    return std::max(over, under) * (1.0 + RING_ROUNDING);
}

}  // namespace

RingBounds ring_bounds(std::span<const SpaceCorners> corners,
                       std::span<const std::int32_t> vertices, std::span<const std::int32_t> twins,
                       std::span<const TriangleBounds> bounds, std::span<const double> limits) {
    const std::size_t count = corners.size();
    Shapes shapes(corners, bounds);
    RingBounds found{Array<double>::unfilled(count), Array<std::uint8_t>::unfilled(count)};
    for (std::size_t t = 0; t < count; ++t) {
        const TriangleBounds& own = bounds[t];
        double most = own.whole, corner = own.corner;
        // with neighbours it is no lower than the height
        if (!(own.whole + corner <= limits[t] && own.whole <= (1.0 + LITTLE_LOWER) * own.height))
            most = shapes.at(t).is_known ? own.height : intervals::INFINITE;
        for (std::size_t k = 0; k < 3 && most < own.whole; ++k) {
            const Side side{shapes.at(t), own, k};
            const std::int32_t twin = twins[3 * t + k];
            if (twin == NIL) {
                most = std::max(most, cost_of_rim(side));
                continue;
            }
            const auto other = static_cast<std::size_t>(twin / 3);
            const bool run_alike = vertices[3 * t + k] == vertices[twin];
            const Side across{shapes.at(other), bounds[other], static_cast<std::size_t>(twin % 3)};
            most = std::max(
                most, other == t ? intervals::INFINITE : cost_of_side(side, across, run_alike));
            corner = std::max(corner, bounds[other].corner);
        }
        found.by_ring[t] = most < own.whole ? 1 : 0;
        const double bound = std::min(most, own.whole) + corner;
        found.bound[t] =
            bound <= intervals::INFINITE ? bound * (1.0 + RING_ROUNDING) : intervals::INFINITE;
    }
    return found;
}

}  // namespace surfmesh
