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

}  // namespace

double metric_area_of_box(const Background& b, double x1, double y1) {
    double total = 0.0;
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
                const double across = std::min(1.0, (x1 - at.x) / at.wide);
                const double up = std::min(1.0, (y1 - at.y) / at.high);
                total += at.wide * at.high * across * up * mean_density(b, at.cell, across, up);
                continue;
            }
            for (int k = 0; k < 4; ++k)
                stack.push_back({first + k, at.x + 0.5 * at.wide * (k % 2),
                                 at.y + 0.5 * at.high * (k / 2), 0.5 * at.wide, 0.5 * at.high});
        }
    }
    return total;
}

std::size_t expected_circles(const Background& background, Point2 upper) {
    constexpr double COUNTABLE = 1e18;  // more are as many
    const double area = metric_area_of_box(background, upper.x, upper.y);
    const double circles = area * 2.0 / std::sqrt(3.0);
    return static_cast<std::size_t>(circles < COUNTABLE ? circles : COUNTABLE) + 100;
}

}  // namespace surfmesh
