#include "packing/line_of_circles.hpp"

#include <cmath>

namespace surfmesh {
namespace {

constexpr int BEYOND = 4;            // circles outside the box at each end, before the last
constexpr int STEPS = 12;            // of the search for a circle's place
constexpr double TOUCHING = 1.0e-6;  // metric distance of centres: 1 -+ this

Circle circle_at(const CircleSizes& sizes, Point2 place, Point2 way) {
    return {place, sizes.along(place, way)};
}

/// The circle that touches ``last`` on the ray from its centre.
Circle next_along(const CircleSizes& sizes, const Circle& last, Point2 ray) {
    double distance = 1.0 / norm(solve(last.size, ray));
    Circle found = last;
    for (int step = 0; step < STEPS; ++step) {
        found = circle_at(sizes, last.centre + distance * ray, ray);
        const double length = norm(solve(0.5 * (last.size + found.size), distance * ray));
        if (!(std::abs(length - 1.0) > TOUCHING)) break;
        distance /= length;
    }
    return found;
}

/// Circles on a ray as far as ``end``, ``first`` not among them, and one ``far`` beyond.
///
/// False where there would be more than ``most``.
bool follow(const CircleSizes& sizes, const Circle& first, Point2 ray, double end, double far,
            std::size_t most, Array<Circle>& found) {
    Circle last = first;
    for (int beyond = 0; beyond < BEYOND;) {
        const Circle next = next_along(sizes, last, ray);
        const double along = dot(next.centre, ray);
        if (!(along > dot(last.centre, ray)) || found.size() == most) return false;
        found.push_back(next);
        beyond += along > end;
        last = next;
    }
    found.push_back(circle_at(sizes, last.centre + far * ray, ray));
    return true;
}

}  // namespace

Array<Circle> circles_along(const CircleSizes& sizes, const StraightLine& line, Point2 low,
                            Point2 high, std::size_t most) {
    const Circle middle = circle_at(sizes, line.through, line.direction);
    const Point2 on = line.direction, back = -1.0 * on;
    const double far = 2.0 * norm(high - low);
    Array<Circle> before, after, all;
    if (!follow(sizes, middle, back, dot(low, back), far, most, before) ||
        !follow(sizes, middle, on, dot(high, on), far, most, after))
        return all;
    for (std::size_t k = before.size(); k > 0; --k)
        all.push_back(before[static_cast<std::ptrdiff_t>(k) - 1]);
    all.push_back(middle);
    for (const Circle& circle : after) all.push_back(circle);
    return all;
}

}  // namespace surfmesh
