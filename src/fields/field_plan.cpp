#include "fields/field_plan.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr int CELLS_OF_PIECE = 16, FEWEST_CELLS = 64, MOST_CELLS = 2304;  // of a face

constexpr int LONGEST_ROW = 2048;  // root cells along the longer side of a narrow plane, at most

/// A whole number between two, of a number of any size.
int whole_between(double x, int low, int high) {
    return static_cast<int>(
        std::clamp(std::nearbyint(x), static_cast<double>(low), static_cast<double>(high)));
}

/// On the finest grid, of so many root cells over a length.
std::int64_t grid_place(double x, double step, double length) {
    constexpr auto UNIT = static_cast<double>(std::int64_t{1} << GRID_DEPTH);
    const double last = std::nearbyint(length / step * UNIT) - 1.0;
    return static_cast<std::int64_t>(std::clamp(x / step * UNIT, 0.0, last));
}

/// How often a cell is halved until it is no wider than a size: ceil(log2(width / size)), exactly.
std::int64_t halvings(double width, double size) {
    const double ratio = width / size;
    if (!std::isfinite(ratio)) return GRID_DEPTH;
    int exponent = 0;
    const double fraction = std::frexp(ratio, &exponent);
    return std::clamp(fraction > 0.5 ? exponent : exponent - 1, 0, GRID_DEPTH);
}

}  // namespace

int root_cells_of_face(int pieces) {
    return std::clamp(std::min(pieces, MOST_CELLS) * CELLS_OF_PIECE, FEWEST_CELLS, MOST_CELLS);
}

RootGrid root_grid(Point2 extent, int cells) {
    const double longest = std::max(extent.x, extent.y), shortest = std::min(extent.x, extent.y);
    const double ratio = longest / shortest;
    const int most = std::max(cells / 4, whole_between(2.0 * ratio, 0, LONGEST_ROW));
    const int longer = std::min(whole_between(std::sqrt(cells * ratio), 4, most), most);
    const int least = longer > cells / 4 ? 2 : 4;
    const int shorter =
        std::min(whole_between(static_cast<double>(cells) / longer, least, cells), cells / 4);
    return extent.x > extent.y ? RootGrid{longer, shorter} : RootGrid{shorter, longer};
}

Array<SmallSource> small_sources(std::span<const Point2> places, std::span<const double> sizes,
                                 RootGrid grid, Point2 extent) {
    const Point2 step{extent.x / grid.nx, extent.y / grid.ny};
    // the leaves are split once more at the end
    const double width = 0.5 * std::max(step.x, step.y);
    Array<SmallSource> found;
    found.reserve(places.size());
    for (std::size_t k = 0; k < places.size(); ++k)
        found.push_back({grid_place(places[k].x, step.x, extent.x),
                         grid_place(places[k].y, step.y, extent.y), halvings(width, sizes[k])});
    return found;
}

}  // namespace surfmesh
