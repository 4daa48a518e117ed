#include "faces/alike_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "faces/loop_figures.hpp"

namespace surfmesh {
namespace {

constexpr int BITS = 20;  // to which alike faces agree in lengths, areas and sizes: six digits

double rounded(double value) {
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    return std::ldexp(std::nearbyint(std::ldexp(fraction, BITS)), exponent - BITS);
}

double fewest_of(const Array<LoopFigures>& loops) {
    double segments = 0.0;
    for (const LoopFigures& loop : loops) segments += loop.segments;
    return segments + 2.0 * static_cast<double>(loops.size()) - 4.0;
}

double mean_size(const Array<LoopFigures>& loops) {
    double sizes = 0.0, sized = 0.0;
    for (const LoopFigures& loop : loops) {
        sizes += loop.sizes;
        sized += loop.sized;
    }
    return sized > 0.0 ? sizes / sized : std::numeric_limits<double>::infinity();
}

/// What is the same of alike faces: loops come in any order.
std::vector<double> likeness(std::int64_t sort, double area, const Array<LoopFigures>& loops) {
    std::vector<std::array<double, 3>> rows;
    for (const LoopFigures& loop : loops)
        rows.push_back({loop.segments, rounded(loop.length), rounded(loop.sizes)});
    std::sort(rows.begin(), rows.end());
    std::vector<double> found{static_cast<double>(sort), rounded(area)};
    for (const auto& row : rows) found.insert(found.end(), row.begin(), row.end());
    return found;
}

}  // namespace

double fewest_triangles(const FaceBoundary& boundary) { return fewest_of(loop_figures(boundary)); }

AlikeFaces alike_faces(const std::vector<const FaceBoundary*>& boundaries,
                       std::span<const double> areas, std::span<const std::int64_t> sorts) {
    AlikeFaces found;
    std::map<std::vector<double>, std::int64_t> known;
    for (std::size_t face = 0; face < boundaries.size(); ++face) {
        const Array<LoopFigures> loops = loop_figures(*boundaries[face]);
        found.fewest.push_back(fewest_of(loops));
        found.size.push_back(mean_size(loops));
        const auto [place, is_new] = known.try_emplace(likeness(sorts[face], areas[face], loops),
                                                       static_cast<std::int64_t>(known.size()));
        if (is_new) found.first_of.push_back(static_cast<std::int64_t>(face));
        found.class_of.push_back(place->second);
    }
    return found;
}

}  // namespace surfmesh
