#include "fields/coverage.hpp"

#include <cmath>

namespace surfmesh {
namespace {

/// Mean of det A over the lower left part of a leaf, `across` by `up` of it.
double mean_density(const Background& b, Cell cell, double across, double up) {
    const double gauss = 0.5 - 0.5 / std::sqrt(3.0);
    double total = 0.0;
    for (int k = 0; k < 4; ++k) {
        const double s = across * (k % 2 == 0 ? gauss : 1.0 - gauss);
        const double t = up * (k < 2 ? gauss : 1.0 - gauss);
        SizeTensor a{0.0, 0.0, 0.0};
        for (int c = 0; c < 4; ++c) {
            const double w = (c % 2 != 0 ? s : 1.0 - s) * (c > 1 ? t : 1.0 - t);
            a = a + w * b.metric_root[b.corner[cell].node[c]].metric_root;
        }
        total += 0.25 * determinant(a);
    }
    return total;
}

struct PlacedCell {
    Cell cell;
    double x, y, wide, high;
};

/// The metric area of a leaf's part to the left of x1 and below y1.
double area_within(const Background& b, const PlacedCell& at, double x1, double y1) {
    const double across = std::min(1.0, (x1 - at.x) / at.wide);
    const double up = std::min(1.0, (y1 - at.y) / at.high);
    return at.wide * at.high * across * up * mean_density(b, at.cell, across, up);
}

/// Call visit(leaf) for the leaves that are not wholly to the right of x1 or above y1.
template <class Visit>
void for_leaves(const Background& b, double x1, double y1, const Visit& visit) {
    Array<PlacedCell> stack;
    for (Cell root = 0; root < b.grid.nx * b.grid.ny; ++root) {
        stack.push_back({root, b.box.x0 + (root % b.grid.nx) / b.box.across,
                         b.box.y0 + (root / b.grid.nx) / b.box.up, 1.0 / b.box.across,
                         1.0 / b.box.up});
        while (!stack.empty()) {
            const PlacedCell at = stack.pop_back();
            if (at.x >= x1 || at.y >= y1) continue;
            const Cell first = b.child[at.cell];
            if (first < 0) {
                visit(at);
                continue;
            }
            for (int k = 0; k < 4; ++k)
                stack.push_back({first + k, at.x + 0.5 * at.wide * (k % 2),
                                 at.y + 0.5 * at.high * (k / 2), 0.5 * at.wide, 0.5 * at.high});
        }
    }
}

}  // namespace

double metric_area_of_box(const Background& b, double x1, double y1) {
    double total = 0.0;
    for_leaves(b, x1, y1, [&](const PlacedCell& leaf) { total += area_within(b, leaf, x1, y1); });
    return total;
}

LeafAreas leaf_areas(const Background& b, double x1, double y1) {
    LeafAreas found;
    for_leaves(b, x1, y1, [&](const PlacedCell& leaf) {
        found.low.push_back({leaf.x, leaf.y});
        found.step.push_back({std::min(leaf.wide, x1 - leaf.x), std::min(leaf.high, y1 - leaf.y)});
        found.area.push_back(area_within(b, leaf, x1, y1));
    });
    return found;
}

double halving_coordinate(const Background& b, Axis axis, double low, Point2 upper,
                          int bisections) {
    const bool is_x = axis == Axis::x;
    double high = is_x ? upper.x : upper.y, before = 0.0;
    struct Leaf {
        PlacedCell at;
        double area;
    };
    Array<Leaf> open;  // leaves that [low, high] may cut
    for_leaves(b, upper.x, upper.y, [&](const PlacedCell& leaf) {
        open.push_back({leaf, area_within(b, leaf, upper.x, upper.y)});
        before += open.back().area;
    });
    const double half = 0.5 * before;
    before = 0.0;  // of the leaves that end at or before ``low``
    for (int step = 0; step < bisections; ++step) {
        const double middle = 0.5 * (low + high);
        double left = before;
        for (const auto& [at, area] : open) {
            const double first = is_x ? at.x : at.y, last = first + (is_x ? at.wide : at.high);
            if (last <= middle)
                left += area;
            else if (first < middle)
                left += is_x ? area_within(b, at, middle, upper.y)
                             : area_within(b, at, upper.x, middle);
        }
        (left < half ? low : high) = middle;
        std::size_t kept = 0;
        for (const Leaf& leaf : open) {
            const double first = is_x ? leaf.at.x : leaf.at.y;
            const double last = first + (is_x ? leaf.at.wide : leaf.at.high);
            if (last <= low)
                before += leaf.area;
            else if (first < high)
                open[kept++] = leaf;
        }
        open.resize(kept);
    }
    return 0.5 * (low + high);
}

std::size_t expected_circles(const Background& background, Point2 upper) {
    constexpr double COUNTABLE = 1e18;  // more are as many
    const double area = metric_area_of_box(background, upper.x, upper.y);
    const double circles = area * 2.0 / std::sqrt(3.0);
    return static_cast<std::size_t>(circles < COUNTABLE ? circles : COUNTABLE) + 100;
}

}  // namespace surfmesh
