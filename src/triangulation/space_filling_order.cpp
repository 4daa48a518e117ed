#include "triangulation/space_filling_order.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::uint32_t CELLS = 1u << 20;         // along each side of the grid
constexpr std::size_t PLACES_TOGETHER = 1 << 16;  // points whose places are found together

struct Placed {
    std::uint64_t along;  // the curve
    Vertex v;
};

bool is_before(const Placed& a, const Placed& b) {
    return a.along != b.along ? a.along < b.along : a.v < b.v;
}

/// The number of cell (x, y) along the curve: two bits a level, the frame turned for the next.
///
///     1 -- 2        within 0 the curve runs as in the whole, mirrored at the rising diagonal,
///     |    |        within 3 at the falling one
///     0    3
std::uint64_t place_along(std::uint32_t x, std::uint32_t y) {
    std::uint64_t place = 0;
    for (std::uint32_t side = CELLS / 2; side > 0; side /= 2) {
        const std::uint32_t right = (x & side) != 0, upper = (y & side) != 0;
        place = 4 * place + ((3 * right) ^ upper);
        // without branches, which nothing foretells: CELLS - 1 - x where lower right, and the two
        // swapped where lower
        const std::uint32_t lower = upper - 1, mirrored = (CELLS - 1) & lower & (0 - right);
        x ^= mirrored;
        y ^= mirrored;
        const std::uint32_t difference = (x ^ y) & lower;
        x ^= difference;
        y ^= difference;
    }
    return place;
}

struct Grid {
    Point2 low;
    double cells_per_unit;

    [[nodiscard]] std::uint64_t place(Point2 p) const {
        const auto cell = [this](double x, double from) {
            return static_cast<std::uint32_t>(
                std::clamp((x - from) * cells_per_unit, 0.0, double(CELLS - 1)));
        };
        return place_along(cell(p.x, low.x), cell(p.y, low.y));
    }
};

Grid grid_over(std::span<const Point2> points, std::span<const Vertex> some) {
    Point2 low = points[some[0]], high = low;
    for (const Vertex v : some) {
        const Point2 p = points[v];
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const double side = std::max(high.x - low.x, high.y - low.y);
    return {low, side > 0.0 ? CELLS / side : 0.0};
}

}  // namespace

Array<Vertex> along_hilbert_curve(std::span<const Point2> points, std::span<const Vertex> some) {
    auto order = Array<Vertex>::unfilled(some.size());
    if (some.empty()) return order;
    const Grid grid = grid_over(points, some);
    auto placed = Array<Placed>::unfilled(some.size());
    for_each_block(some.size(), PLACES_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k)
            placed[k] = {grid.place(points[some[k]]), some[k]};
        std::sort(placed.data() + first, placed.data() + last, is_before);
    });
    for (std::size_t width = PLACES_TOGETHER; width < some.size(); width *= 2) {
        for_each_block(some.size(), 2 * width, [&](std::size_t first, std::size_t last) {
            if (first + width >= last) return;
            std::inplace_merge(placed.data() + first, placed.data() + first + width,
                               placed.data() + last, is_before);
        });
    }
    for_each_block(some.size(), PLACES_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) order[k] = placed[k].v;
    });
    return order;
}

}  // namespace surfmesh
