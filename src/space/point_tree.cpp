#include "space/point_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "values/conventions.hpp"

namespace surfmesh {
namespace {

constexpr std::int32_t FEW = 8;  // points of a part that is not halved

double coordinate(Point3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// Square of the distance from a place to a box.
double square_to_box(const double (&low)[3], const double (&high)[3], Point3 place) {
    double square = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double x = coordinate(place, axis);
        const double away = std::max(std::max(low[axis] - x, x - high[axis]), 0.0);
        square += away * away;
    }
    return square;
}

bool is_nearer(const NearPoint& a, const NearPoint& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.number < b.number);
}

/// Put a point among the nearest ones found so far.
void insert(NearPoint point, std::span<NearPoint> near, std::size_t& found) {
    if (found == near.size()) {
        if (!is_nearer(point, near[found - 1])) return;
        --found;
    }
    std::size_t k = found++;
    for (; k > 0 && is_nearer(point, near[k - 1]); --k) near[k] = near[k - 1];
    near[k] = point;
}

}  // namespace

PointTree::PointTree(std::span<const Point3> points) : points_(points), number_(points.size()) {
    std::iota(number_.begin(), number_.end(), 0);
    parts_.push_back({{}, {}, 0, static_cast<std::int32_t>(points.size()), NIL});
    for (std::size_t part = 0; part < parts_.size(); ++part) build(static_cast<std::int32_t>(part));
    for (std::size_t k = 0; k < number_.size(); ++k) points_[k] = points[number_[k]];
}

/// Find the box of a part, and halve it across its longest side.
void PointTree::build(std::int32_t number) {
    Part part = parts_[number];
    int widest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::int32_t k = part.first; k < part.last; ++k) {
            const double x = coordinate(points_[number_[k]], axis);
            low = std::min(low, x);
            high = std::max(high, x);
        }
        part.low[axis] = low;
        part.high[axis] = high;
        if (high - low > part.high[widest] - part.low[widest]) widest = axis;
    }
    if (part.last - part.first > FEW) {
        const std::int32_t middle = (part.first + part.last) / 2;
        const auto before = [&](std::int32_t a, std::int32_t b) {
            const double x = coordinate(points_[a], widest), y = coordinate(points_[b], widest);
            return x < y || (x == y && a < b);
        };
        std::nth_element(number_.begin() + part.first, number_.begin() + middle,
                         number_.begin() + part.last, before);
        part.child = static_cast<std::int32_t>(parts_.size());
        parts_.push_back({{}, {}, part.first, middle, NIL});
        parts_.push_back({{}, {}, middle, part.last, NIL});
    }
    parts_[number] = part;
}

void PointTree::search(std::int32_t number, Point3 place, std::span<NearPoint> near,
                       std::size_t& found) const {
    const Part& part = parts_[number];
    if (part.child == NIL) {
        for (std::int32_t k = part.first; k < part.last; ++k) {
            const Point3 d = place - points_[k];
            insert({d.x * d.x + d.y * d.y + d.z * d.z, number_[k]}, near, found);
        }
        return;
    }
    const auto square = [&](std::int32_t half) {
        return square_to_box(parts_[half].low, parts_[half].high, place);
    };
    std::int32_t first = part.child, second = first + 1;
    double nearer = square(first), farther = square(second);
    if (farther < nearer) {
        std::swap(first, second);
        std::swap(nearer, farther);
    }
    // as near as the last one found may still be nearer by its number
    for (const auto& [half, away] : {std::pair{first, nearer}, std::pair{second, farther}})
        if (found < near.size() || away <= near[found - 1].distance)
            search(half, place, near, found);
}

std::size_t PointTree::nearest(Point3 place, std::span<NearPoint> near) const {
    std::size_t found = 0;
    if (!near.empty() && size() > 0) search(0, place, near, found);
    for (std::size_t k = 0; k < found; ++k) near[k].distance = std::sqrt(near[k].distance);
    return found;
}

void nearest_points(const PointTree& tree, std::span<const Point3> places, std::size_t count,
                    std::span<double> distance, std::span<std::int32_t> number) {
    Array<NearPoint> near(count);
    for (std::size_t i = 0; i < places.size(); ++i) {
        tree.nearest(places[i], {near.data(), count});
        for (std::size_t k = 0; k < count; ++k) {
            distance[i * count + k] = near[k].distance;
            number[i * count + k] = near[k].number;
        }
    }
}

}  // namespace surfmesh
