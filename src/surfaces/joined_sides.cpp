#include "surfaces/joined_sides.hpp"

#include <cmath>

namespace surfmesh {
namespace {

using Kind = JoinedSides::Kind;

// Along a side: uneven, and each with its mirror image behind it.
constexpr std::array ALONG = {0.0, 1.0, 0.07, 0.93, 0.19, 0.81, 0.33, 0.67, 0.46, 0.54};
constexpr double SAME_POINT = 1e-9;  // of the extent of all sides

/// Mirrored pairs of ``ALONG`` stand side by side.
constexpr std::size_t mirrored(std::size_t k) { return k ^ 1U; }

/// Are two sides one? What has no value is not.
Kind kind_of(std::span<const Point3> first, std::span<const Point3> second, double near) {
    bool same = true, mirror = true;
    for (std::size_t k = 0; k < ALONG.size(); ++k) {
        same = same && norm(second[k] - first[k]) <= near;
        mirror = mirror && norm(second[mirrored(k)] - first[k]) <= near;
    }
    return same ? Kind::SAME : mirror ? Kind::MIRRORED : Kind::OPEN;
}

double extent(std::span<const Point3> points) {
    double largest = 0.0;
    for (const Point3 p : points) largest = std::max(largest, norm(p - points[0]));
    return largest;
}

/// ``across`` moved by the width of its range where it lies beyond; whether it was.
bool moved_within(double& across, double low, double high) {
    const double before = across;
    if (across < low) across += high - low;
    if (across > high) across -= high - low;
    return across != before;
}

}  // namespace

Point2 JoinedSides::crossed(Point2 p, const ParameterBox& box) const {
    if (u != Kind::OPEN && moved_within(p.x, box.low.x, box.high.x) && u == Kind::MIRRORED)
        p.y = box.low.y + box.high.y - p.y;
    if (v != Kind::OPEN && moved_within(p.y, box.low.y, box.high.y) && v == Kind::MIRRORED)
        p.x = box.low.x + box.high.x - p.x;
    return p;
}

JoinedSides joined_sides(SurfaceReader& surface) {
    const ParameterBox box = surface.domain();
    const auto at = [](double t, double low, double high) {  // both ends are exact
        return t < 1.0 ? low + t * (high - low) : high;
    };
    constexpr std::size_t N = ALONG.size();
    std::array<Point2, 4 * N> places;
    for (std::size_t k = 0; k < N; ++k) {
        const double x = at(ALONG[k], box.low.x, box.high.x),
                     y = at(ALONG[k], box.low.y, box.high.y);
        places[k] = {box.low.x, y};
        places[N + k] = {box.high.x, y};
        places[2 * N + k] = {x, box.low.y};
        places[3 * N + k] = {x, box.high.y};
    }
    surface.read(places, 0);
    const std::span<const Point3> found = surface[0];
    const double near = SAME_POINT * extent(found);
    return {kind_of(found.subspan(0, N), found.subspan(N, N), near),
            kind_of(found.subspan(2 * N, N), found.subspan(3 * N, N), near)};
}

}  // namespace surfmesh
