#include "surfaces/coincident_sides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "surfaces/box_diagonal.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t SAMPLES_OF_SIDE = 65;  // on a side; uneven, so that symmetry fools nobody
constexpr int COARSE = 8;  // steps of the grid that shows how large the surface is

// Opposite sides first: where several sides coincide, that is what is meant.
constexpr std::pair<std::size_t, std::size_t> PAIRS[] = {{1, 3}, {0, 2}, {0, 1},
                                                         {1, 2}, {2, 3}, {0, 3}};

/// Uneven parameters in [0, 1], symmetric under t -> 1 - t, both ends included.
std::array<double, SAMPLES_OF_SIDE> uneven_samples() {
    constexpr std::size_t HALF = (SAMPLES_OF_SIDE - 1) / 2;
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    std::array<double, SAMPLES_OF_SIDE> t{};
    for (std::size_t k = 1; k < HALF; ++k)
        t[k] = 0.5 * std::fmod(static_cast<double>(k) * golden, 1.0);
    std::sort(t.begin() + 1, t.begin() + HALF);
    t[HALF] = 0.5;
    for (std::size_t k = 0; k < HALF; ++k) t[SAMPLES_OF_SIDE - 1 - k] = 1.0 - t[k];
    return t;
}

/// A grid over the unit square, then the samples of each side.
Array<Point2> unit_places() {
    Array<Point2> places;
    for (int row = 0; row <= COARSE; ++row)
        for (int column = 0; column <= COARSE; ++column)
            places.push_back(
                {static_cast<double>(column) / COARSE, static_cast<double>(row) / COARSE});
    constexpr double FIXED[] = {0.0, 1.0, 1.0, 0.0};
    for (std::size_t side = 0; side < 4; ++side)
        for (const double t : uneven_samples())
            places.push_back(side % 2 == 0 ? Point2{t, FIXED[side]} : Point2{FIXED[side], t});
    return places;
}

/// A fraction of the way; the far end is exact.
double part_of_way(double low, double high, double t) {
    return t < 1.0 ? low + t * (high - low) : high;
}

/// The largest difference of two curves in any coordinate.
double farthest(std::span<const Point3> one, std::span<const Point3> other, bool backwards) {
    double most = 0.0;
    for (std::size_t k = 0; k < one.size(); ++k) {
        const Point3 d = one[k] - other[backwards ? other.size() - 1 - k : k];
        for (const double x : {d.x, d.y, d.z}) {
            if (std::isnan(x)) return std::numeric_limits<double>::infinity();
            most = std::max(most, std::abs(x));
        }
    }
    return most;
}

}  // namespace

CoincidentSides coincident_sides(SurfaceReader& surface, const std::array<double, 4>& rounding) {
    static const Array<Point2> PLACES = unit_places();
    const auto [low, high] = surface.domain();
    Array<Point2> uv;
    uv.reserve(PLACES.size());
    for (const Point2 p : PLACES)
        uv.push_back({part_of_way(low.x, high.x, p.x), part_of_way(low.y, high.y, p.y)});
    surface.read(uv, 0);
    const std::span<const Point3> cloud = surface[0];
    const double whole = box_diagonal(cloud);
    CoincidentSides found;
    std::array<double, 4> near{};
    std::array<std::span<const Point3>, 4> curve;
    for (std::size_t side = 0; side < 4; ++side) {
        near[side] = whole * std::max(SAME_SIDE, rounding[side]);
        curve[side] = cloud.subspan(cloud.size() - (4 - side) * SAMPLES_OF_SIDE, SAMPLES_OF_SIDE);
        found.collapsed[side] = box_diagonal(curve[side]) <= near[side];
    }
    for (const auto& [first, second] : PAIRS) {
        if (found.collapsed[first] || found.collapsed[second]) continue;
        if (found.partner[first] >= 0 || found.partner[second] >= 0) continue;
        const double most = std::max(near[first], near[second]);
        for (const bool backwards : {false, true}) {
            if (!(farthest(curve[first], curve[second], backwards) <= most)) continue;
            found.partner[first] = static_cast<int>(second);
            found.partner[second] = static_cast<int>(first);
            found.reversed[first] = found.reversed[second] = backwards;
            break;
        }
    }
    return found;
}

}  // namespace surfmesh
