#include "insertion/coincident_nodes.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace surfmesh {
namespace {

/// The nodes with those of one number in a row, each group in the order of the nodes.
std::vector<std::int32_t> sorted_by_number(std::span<const std::int64_t> numbers) {
    std::vector<std::int32_t> order(numbers.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::int32_t>(k);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::int32_t a, std::int32_t b) { return numbers[a] < numbers[b]; });
    return order;
}

/// Places in units of the box of all.
Array<Point2> in_unit_box(std::span<const Point2> uv) {
    Array<Point2> place(uv);
    if (uv.empty()) return place;
    Point2 low = uv[0], high = uv[0];
    for (const Point2 p : uv) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    constexpr double TINY = std::numeric_limits<double>::min();
    const double width = std::max(high.x - low.x, TINY), height = std::max(high.y - low.y, TINY);
    for (Point2& p : place) p = {p.x / width, p.y / height};
    return place;
}

/// Of each node: how near another one is the same.
Array<double> reaches(const Array<Point2>& place, std::span<const Segment> segments) {
    Array<double> near(place.size(), std::numeric_limits<double>::infinity());
    for (const auto [a, b] : segments) {
        const double step = norm(place[b] - place[a]);
        near[a] = std::min(near[a], step);
        near[b] = std::min(near[b], step);
    }
    for (double& reach : near) reach = std::max(NEAR_STEP * reach, SAME_PLACE);
    return near;
}

/// For each node the first that has its number and its place.
Array<std::int32_t> first_coincident(std::span<const Point2> uv,
                                     std::span<const std::int64_t> numbers,
                                     std::span<const Segment> segments) {
    Array<std::int32_t> kept(uv.size());
    for (std::size_t k = 0; k < uv.size(); ++k) kept[k] = static_cast<std::int32_t>(k);
    const std::vector<std::int32_t> order = sorted_by_number(numbers);
    const Array<Point2> place = in_unit_box(uv);
    const Array<double> near = reaches(place, segments);
    for (std::size_t start = 0, k = 1; k < order.size(); ++k) {
        const std::int32_t node = order[k];
        if (numbers[node] != numbers[order[start]]) start = k;
        for (std::size_t i = start; i < k; ++i) {
            const std::int32_t earlier = order[i];
            const double apart = norm(place[node] - place[earlier]);
            if (!(apart <= std::max(near[node], near[earlier]))) continue;
            kept[node] = kept[earlier];
            break;
        }
    }
    return kept;
}

/// For each node the first that has its number.
Array<std::int64_t> first_of_number(std::span<const std::int64_t> numbers) {
    Array<std::int64_t> first(numbers.size());
    std::int32_t start = NIL;
    for (const std::int32_t node : sorted_by_number(numbers)) {
        if (start == NIL || numbers[node] != numbers[start]) start = node;
        first[node] = start;
    }
    return first;
}

/// The segments of closed loops.
Array<Segment> rings(std::span<const std::int32_t> lengths) {
    Array<Segment> segments;
    std::int32_t start = 0;
    for (const std::int32_t length : lengths) {
        for (std::int32_t k = 0; k < length; ++k)
            segments.push_back({start + k, start + (k + 1 < length ? k + 1 : 0)});
        start += length;
    }
    return segments;
}

/// Is a segment there twice, in the same direction?
bool has_repeated(const Array<Segment>& segments) {
    std::vector<std::pair<std::int32_t, std::int32_t>> sorted;
    for (const auto [a, b] : segments) sorted.emplace_back(a, b);
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

}  // namespace

CoincidentNodes coincident_nodes(std::span<const Point2> uv, std::span<const std::int64_t> numbers,
                                 std::span<const Segment> segments) {
    CoincidentNodes found{{}, first_coincident(uv, numbers, segments)};
    Array<std::int32_t> number(uv.size(), NIL);
    for (std::size_t k = 0; k < uv.size(); ++k) {
        std::int32_t& own = number[found.row[k]];  // what is kept comes first
        if (own == NIL) {
            own = static_cast<std::int32_t>(found.nodes.size());
            found.nodes.push_back(found.row[k]);
        }
        found.row[k] = own;
    }
    return found;
}

LoopNodes loop_nodes(std::span<const Point2> uv, std::span<const std::int64_t> numbers,
                     std::span<const std::int32_t> lengths) {
    const Array<Segment> along = rings(lengths);
    CoincidentNodes found = coincident_nodes(uv, numbers, along);
    LoopNodes loops;
    for (const auto [start, end] : along) {
        const Segment segment{found.row[start], found.row[end]};
        if (segment.start != segment.end) loops.segments.push_back(segment);
    }
    loops.runs_twice = has_repeated(loops.segments);
    Array<std::int64_t> kept_numbers;
    for (const std::int32_t node : found.nodes) kept_numbers.push_back(numbers[node]);
    loops.identity = first_of_number(kept_numbers);
    loops.nodes = std::move(found.nodes);
    return loops;
}

}  // namespace surfmesh
