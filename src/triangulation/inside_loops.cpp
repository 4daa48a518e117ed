#include "triangulation/inside_loops.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "triangulation/predicates.hpp"

namespace surfmesh {
namespace {

struct Side {
    Point2 lower, upper;  // lower.y <= upper.y
};

enum class Place { LEFT_OF_SIDE, ELSEWHERE, ON_SIDE };

/// Where a point at the height of a side lies: a ray to the right meets a side at its lower end,
/// not at its upper one.
Place place_of(Point2 p, const Side& side) {
    const auto [low, high] = std::minmax(side.lower.x, side.upper.x);
    if (p.x > high) return Place::ELSEWHERE;
    const bool crosses = p.y < side.upper.y;  // it is not below the lower end
    if (p.x < low) return crosses ? Place::LEFT_OF_SIDE : Place::ELSEWHERE;
    const double area = orient(side.lower, side.upper, p);
    if (area == 0.0) return Place::ON_SIDE;
    return crosses && area > 0.0 ? Place::LEFT_OF_SIDE : Place::ELSEWHERE;
}

/// The sides of one loop, in the order of their lower ends.
Array<Side> sides_of(std::span<const Point2> corners) {
    Array<Side> sides;
    sides.reserve(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point2 a = corners[i], b = corners[(i + 1) % corners.size()];
        sides.push_back(a.y <= b.y ? Side{a, b} : Side{b, a});
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& s, const Side& t) { return s.lower.y < t.lower.y; });
    return sides;
}

/// Passes upwards through the points of one loop.
class Sweep {
  public:
    explicit Sweep(std::span<const Point2> corners) : sides_(sides_of(corners)) {}

    bool is_within(Point2 p) {
        while (next_ < sides_.size() && sides_.data()[next_].lower.y <= p.y)
            at_height_.push_back(sides_.data()[next_++]);
        bool odd = false, is_on_loop = false;
        std::size_t kept = 0;
        for (const Side& side : at_height_) {
            if (side.upper.y < p.y) continue;  // passed
            at_height_.data()[kept++] = side;
            const Place place = place_of(p, side);
            odd ^= place == Place::LEFT_OF_SIDE;
            is_on_loop |= place == Place::ON_SIDE;
        }
        at_height_.resize(kept);
        return odd && !is_on_loop;
    }

  private:
    Array<Side> sides_, at_height_;
    std::size_t next_ = 0;
};

}  // namespace

Array<std::uint8_t> inside_loops(const PlaneLoops& loops, std::span<const Point2> points) {
    Array<std::uint8_t> inside(points.size());
    Array<std::size_t> upwards;
    upwards.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        if (std::isfinite(points[i].x) && std::isfinite(points[i].y)) upwards.push_back(i);
    std::sort(upwards.begin(), upwards.end(),
              [&](std::size_t a, std::size_t b) { return points[a].y < points[b].y; });
    for (std::size_t k = 0; k + 1 < loops.first.size(); ++k) {
        const auto start = static_cast<std::size_t>(loops.first[k]);
        const auto corners =
            loops.corners.subspan(start, static_cast<std::size_t>(loops.first[k + 1]) - start);
        if (corners.size() < 3) continue;
        const auto by_y = [](Point2 a, Point2 b) { return a.y < b.y; };
        const auto by_x = [](Point2 a, Point2 b) { return a.x < b.x; };
        const auto [bottom, top] = std::minmax_element(corners.begin(), corners.end(), by_y);
        const auto [left, right] = std::minmax_element(corners.begin(), corners.end(), by_x);
        const auto* first =
            std::lower_bound(upwards.begin(), upwards.end(), bottom->y,
                             [&](std::size_t i, double y) { return points[i].y < y; });
        Sweep sweep(corners);
        for (; first != upwards.end() && points[*first].y <= top->y; ++first) {
            const Point2 p = points[*first];
            if (p.x < left->x || p.x > right->x) continue;
            inside.data()[*first] ^= static_cast<std::uint8_t>(sweep.is_within(p));
        }
    }
    return inside;
}

}  // namespace surfmesh
