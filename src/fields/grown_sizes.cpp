#include "fields/grown_sizes.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

// Sources to a root cell; every root cell looks at all sources, in all no more than so many.
constexpr double FEW_ROOTS = 2.0, MANY_TESTS = 2e5;

/// No size in the plane counts above so many times the longer side of the box.
constexpr double REACH = 16.0;

/// A box that is a hair too high needs no second row: look-up takes the nearest point.
constexpr double HAIR = 1e-9;

std::int32_t cells_along(double length, double step) {
    return static_cast<std::int32_t>(std::max(1.0, std::ceil(length / step - HAIR)));
}

}  // namespace

GrownTree grow_sizes(const Sources& sources, const PlaneBox& box, Fineness fineness) {
    const double width = box.high.x - box.low.x, height = box.high.y - box.low.y;
    const double wide = std::sqrt(sources.e) * width, high = std::sqrt(sources.g) * height;
    const auto active =
        static_cast<double>(std::count_if(sources.size.begin(), sources.size.end(),
                                          [&](double size) { return size < sources.largest; }));
    constexpr double MOST_ROOTS = MOST_IN_A_ROW * MOST_IN_A_ROW;
    const double wanted = std::max(
        1.0, std::min({active / FEW_ROOTS, MANY_TESTS / std::max(active, 1.0), MOST_ROOTS}));
    const double longer = std::max(wide, high), shorter = std::min(wide, high);
    double side = std::sqrt(longer / wanted) * std::sqrt(shorter);
    if (side > shorter) side = std::max(shorter, longer / wanted);  // one row
    const double along = std::max(std::floor(longer / side), 1.0);
    const double step = longer / std::min(along, static_cast<double>(MOST_IN_A_ROW));
    const RootCells roots{
        box.low.x,  box.low.y,  step / std::sqrt(sources.e), step / std::sqrt(sources.g),
        box.high.x, box.high.y, cells_along(wide, step),     cells_along(high, step)};
    return grow_tree(sources, roots, REACH * std::max(width, height), MOST_SOURCE_CELLS, fineness);
}

}  // namespace surfmesh
