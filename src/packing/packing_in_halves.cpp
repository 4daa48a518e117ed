#include "packing/packing_in_halves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "fields/coverage.hpp"
#include "packing/half_packing.hpp"
#include "packing/line_of_circles.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr double LONGEST_LINE = 20.0;  // circles on it, over the root of all that are expected
constexpr int BISECTIONS = 7;          // for the place of the line
// Of the box's width: how far ``behind`` lies off the line. Flat, so that no circle gets beyond the
// edges between it and the ends of the line, which is some circles longer than the box is wide
constexpr double BEHIND_LAST_CIRCLE = 1e-3;
// For ``Packing::narrow``. Rows that follow a line fit each other so well that what there is too much
// of along them adds up, to one part in twenty where sizes grow from a point on it: without this
// mean alpha of such a square is .988, where it is .996 when packed from its middle
constexpr double NARROW = 1.5;
constexpr double SAME_ROWS = 0.95;    // cosine of six times an angle of 3 degrees
constexpr double BEYOND_LINE = 1e-6;  // of that: the box reaches over the line, or it might miss it

PackingLimits limits_of(Point2 origin, Point2 low, Point2 high) {
    return {origin, low, high, std::numeric_limits<double>::infinity(), std::int64_t{1} << 62};
}

/// A watch that both halves ask, with the circles of both.
class SharedWatch {
  public:
    explicit SharedWatch(const Watch& watch) : watch_(watch) {}

    Watch of_half(int half) {
        if (!watch_) return {};
        return [this, half](Vertex circles) {
            const std::lock_guard alone(mutex_);
            circles_[half] = circles;
            goes_on_ = goes_on_ && watch_(circles_[0] + circles_[1]);
            return goes_on_;
        };
    }

  private:
    const Watch& watch_;
    std::mutex mutex_;
    Vertex circles_[2] = {0, 0};
    bool goes_on_ = true;
};

struct LaidLine {
    StraightLine line;
    Array<Circle> circles;
};

/// Are a row of circles along an axis and one along ``edge`` rows of the same lattice?
bool are_rows_alike(SizeTensor h, Point2 axis, Point2 edge) {
    const Point2 a = unit_step(h, axis), b = unit_step(h, edge);
    const double cosine = dot(a, b), squared = cosine * cosine;  // of the angle between them
    const double sixfold = squared * (squared * (32.0 * squared - 48.0) + 18.0) - 1.0;  // of 6 x it
    return sixfold > SAME_ROWS;
}

/// The line along the axis that needs fewer circles in the middle of the box, of those with edges
/// as they are to be; no circles where there is none.
LaidLine line_through(const CircleSizes& sizes, Point2 low, Point2 high, std::size_t most,
                      std::optional<Point2> edge) {
    StraightLine line{0.5 * (low + high), {1.0, 0.0}};
    const SizeTensor h = sizes.at(line.through);
    const auto circles_on = [&](Point2 axis) {
        line.direction = axis;
        if (edge && !are_rows_alike(h, axis, *edge)) return std::size_t{0};
        return circles_along(sizes, line, low, high, most).size();
    };
    const std::size_t across = circles_on({1.0, 0.0}), upward = circles_on({0.0, 1.0});
    if (across == 0 && upward == 0) return {line, {}};
    if (upward == 0 || (across != 0 && across <= upward)) {
        line.direction = {1.0, 0.0};
        line.through.y = halving_coordinate(sizes.background, Axis::y, low.y, high, BISECTIONS);
    } else {
        line.through.x = halving_coordinate(sizes.background, Axis::x, low.x, high, BISECTIONS);
    }
    return {line, circles_along(sizes, line, low, high, most)};
}

/// The half on the left of the line.
Packing pack_half(const CircleSizes& sizes, Array<Circle> circles, const StraightLine& line,
                  Point2 low, Point2 high, std::size_t room, const Watch& watch) {
    const Point2 left{-line.direction.y, line.direction.x};
    const Point2 first = circles[0].centre;
    const Point2 last = circles.back().centre;
    const double off = BEHIND_LAST_CIRCLE * norm(last - first);
    const Point2 behind = 0.5 * (first + last) - off * left;
    // the box as far as a little to the right of the line
    const Point2 bound = line.through - BEYOND_LINE * off * left;
    if (left.x > 0.0) low.x = bound.x;
    if (left.x < 0.0) high.x = bound.x;
    if (left.y > 0.0) low.y = bound.y;
    if (left.y < 0.0) high.y = bound.y;
    Packing p = empty_packing(limits_of(line.through, low, high), room);
    p.narrow = NARROW;
    const Circle closing{behind, sizes.at(behind)};
    p.end = {start_along(p, {circles.data(), circles.size()}, closing), line.through};
    if (p.end.status == PackingStatus::finished) p.end = advance_front(p, sizes, watch);
    p.heap = {};
    p.waiting = {};
    return p;
}

/// Both halves, side by side. ``counts.halves`` is 0 where they make no whole.
Packing pack_halves(const CircleSizes& sizes, const LaidLine& laid, Point2 low, Point2 high,
                    std::size_t expected, const Watch& watch) {
    SharedWatch shared(watch);
    Packing halves[2];
    for_each_block(2, 1, [&](std::size_t n, std::size_t) {
        Array<Circle> circles(laid.circles);
        StraightLine line = laid.line;
        if (n == 1) {
            std::reverse(circles.begin(), circles.end());
            line.direction = -1.0 * line.direction;
        }
        halves[n] = pack_half(sizes, std::move(circles), line, low, high, expected / 2,
                              shared.of_half(static_cast<int>(n)));
    });
    Packing& whole = halves[0];
    whole.counts.halves = 0;
    for (const Packing& half : halves) {
        if (half.end.status == PackingStatus::finished) continue;
        whole.end = half.end;
        return std::move(whole);
    }
    if (join_halves(whole, halves[1], static_cast<Vertex>(laid.circles.size())))
        whole.counts.halves = 2;
    return std::move(whole);
}

}  // namespace

Packing pack_box(const CircleSizes& sizes, Point2 low, Point2 high, std::size_t expected,
                 const Watch& watch, std::optional<Point2> edge) {
    if (expected >= CIRCLES_FOR_HALVES) {
        const auto most =
            static_cast<std::size_t>(LONGEST_LINE * std::sqrt(static_cast<double>(expected)));
        const LaidLine laid = line_through(sizes, low, high, most, edge);
        if (!laid.circles.empty()) {
            Packing made = pack_halves(sizes, laid, low, high, expected, watch);
            if (made.counts.halves == 2 || made.end.status == PackingStatus::stopped) return made;
        }
    }
    PackingLimits limits = limits_of(0.5 * (low + high), low, high);
    limits.edge = edge;
    return pack(sizes, limits, expected, watch);
}

}  // namespace surfmesh
