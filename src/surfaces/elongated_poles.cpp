#include "surfaces/elongated_poles.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

// Around a pole; and for a first look, which tells how elongated it is to a half at least.
constexpr std::size_t PLACES = 1025, FEW_PLACES = 33;

// How many times as far from the pole as the nearest point of a ring its farthest is, from which a
// pole counts as elongated; and from which it counts as singular.
constexpr double ELONGATED = 4.0, SINGULAR = 150.0;

// Where the ring lies, of the axis: near enough for the surface to be flat, far enough for digits.
constexpr double BESIDE = 1e-3, HALF_PI = 1.5707963267948966;

// Of the ring's mean distance: a side that moves by less is one point.
constexpr double ONE_POINT = 1e-6;

/// The ring about one end of an axis, as steps from the pole.
Array<Point3> ring(SurfaceReader& surface, const Chart& chart, std::size_t axis, bool at_end,
                   std::span<const double> around) {
    const ChartAxis& radial = axis == 0 ? chart.u : chart.v;
    const double beside = radial.parameter((at_end ? 1.0 - BESIDE : BESIDE) * radial.extent).value;
    const double end = radial.parameter(at_end ? radial.extent : 0.0).value;
    Array<Point2> uv;
    for (const double r : {end, beside})
        for (const double s : around) uv.push_back(axis == 0 ? Point2{r, s} : Point2{s, r});
    surface.read(uv, 0);
    Array<Point3> steps;
    const auto r = surface[0];
    const std::size_t count = around.size();
    double moved = 0.0, far = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        moved = std::max(moved, norm(r[k] - r[0]));
        steps.push_back(r[count + k] - r[0]);
        far += norm(steps[k]);
    }
    // not a number where the surface has no value there: no pole then
    if (!(moved * static_cast<double>(count) <= ONE_POINT * far)) return {};
    return steps;
}

/// The farthest over the nearest.
double elongation(const Array<Point3>& steps) {
    double least = norm(steps[0]), most = least;
    for (const Point3 step : steps) {
        least = std::min(least, norm(step));
        most = std::max(most, norm(step));
    }
    return most / least;
}

/// Angles between a step and the next, added up, in parts of the whole.
void add_angles(const Array<Point3>& steps, Array<double>& turned) {
    Array<double> angle(steps.size(), 0.0);
    for (std::size_t k = 1; k < steps.size(); ++k) {
        const double sine = norm(cross(steps[k - 1], steps[k]));
        const double length = norm(steps[k - 1]) * norm(steps[k]);
        // the sine will do: steps are short, and so no function is asked for
        angle[k] = angle[k - 1] + std::min(sine / length, 1.0);
    }
    for (std::size_t k = 0; k < steps.size(); ++k) turned[k] += angle[k] / angle.end()[-1];
}

Array<double> even_places(double first, double last, std::size_t count) {
    Array<double> places(count);
    for (std::size_t k = 0; k < count; ++k)
        places[k] = first + (last - first) * (static_cast<double>(k) / double(count - 1));
    return places;
}

/// Distances from the pole over the least of them.
Array<double> elongations(const Array<Point3>& steps) {
    Array<double> found;
    for (const Point3 step : steps) found.push_back(norm(step));
    const double least = *std::min_element(found.begin(), found.end());
    for (double& x : found) x /= least;
    return found;
}

/// Is it worth a closer look?
bool may_be_elongated(SurfaceReader& surface, const Chart& chart, std::size_t axis) {
    const auto [low, high] = surface.domain();
    const auto around =
        axis == 0 ? even_places(low.y, high.y, FEW_PLACES) : even_places(low.x, high.x, FEW_PLACES);
    for (const bool at_end : {false, true}) {
        const Array<Point3> steps = ring(surface, chart, axis, at_end, around);
        if (surface.failed()) return false;
        if (!steps.empty() && elongation(steps) >= 0.5 * ELONGATED) return true;
    }
    return false;
}

}  // namespace

std::optional<ElongatedPoles> find_elongated_poles(SurfaceReader& surface, const Chart& chart) {
    const auto [low, high] = surface.domain();
    for (const std::size_t axis : {std::size_t{1}, std::size_t{0}}) {
        if (!may_be_elongated(surface, chart, axis)) continue;
        const auto around =
            axis == 0 ? even_places(low.y, high.y, PLACES) : even_places(low.x, high.x, PLACES);
        ElongatedPoles poles{axis, {false, false}, Array<double>(PLACES, 0.0)};
        bool elongated = false;
        for (const bool at_end : {false, true}) {
            const Array<Point3> steps = ring(surface, chart, axis, at_end, around);
            if (surface.failed()) return std::nullopt;
            if (steps.empty()) continue;
            const double ratio = elongation(steps);
            elongated = elongated || (ratio >= ELONGATED && ratio <= SINGULAR);
            poles.is_pole[at_end ? 1 : 0] = ratio <= SINGULAR;
            if (ratio <= SINGULAR) add_angles(steps, poles.turned);
        }
        if (elongated) return poles;
    }
    return std::nullopt;
}

PoleScaling scaling_by(SurfaceReader& surface, const Chart& chart, const ElongatedPoles& poles) {
    const ChartAxis& other = poles.axis == 0 ? chart.v : chart.u;
    Array<double> around = even_places(0.0, other.extent, PLACES);
    for (double& s : around) s = other.parameter(s).value;
    const auto [first, last] = poles.is_pole;
    PoleScaling made{poles.axis, PoleEnds::both, 0.0, {}, {}};
    if (!(first && last)) made.poles = first ? PoleEnds::first : PoleEnds::last;
    double largest = 1.0;
    for (const bool at_end : {false, true}) {
        Array<double> k(2, 1.0);
        if (at_end ? last : first)
            k = elongations(ring(surface, chart, poles.axis, at_end, around));
        largest = std::max(largest, *std::max_element(k.begin(), k.end()));
        (at_end ? made.last : made.first) = even_cubic(other.extent, std::move(k));
    }
    // dw/dt at the end without a pole lies between 1 / largest and largest then
    made.c = HALF_PI - 1.0 / (HALF_PI * largest);
    return made;
}

}  // namespace surfmesh
