#include "surfaces/chart_making.hpp"

#include <algorithm>
#include <cmath>

#include "surfaces/elongated_poles.hpp"
#include "surfaces/monotone_cubic.hpp"
#include "values/pairwise_sum.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t ACROSS = 17;  // lines along which a surface is sampled

// Ratio of the largest to the smallest mean speed above which an axis is bent, and the smallest
// speed that is told apart, relative to the mean: a stop is not infinitely long.
constexpr double UNEVEN = 1.3, SLOWEST = 1e-4;
constexpr std::size_t KNOTS = 1024;

// How much of an axis around elongated poles is by length, and not by the angle about them.
constexpr double BY_LENGTH = 0.1;

// Ratio of the length by speeds at the samples to that of the chords between them from which the
// samples miss something: tan(u) up to 1.57 has 93 % of its length in the last of 257 steps. Then
// steps are halved: those longer than a fraction of the whole, unless they are as short as a
// fraction of the domain, or so many already.
constexpr double MISSED = 1.5, LONG_STEP = 1.0 / 64.0, FINEST_STEP = 1e-14;
constexpr std::size_t MOST_STEPS = 4000;

/// One axis of a surface, and the lines along it.
struct Lines {
    SurfaceReader& surface;
    std::size_t axis;
    const Array<BentPiece>& pieces;
    double low, high;                       // of the axis
    double first, last;                     // across it
    std::size_t samples;                    // along each
    const Array<double>* turned = nullptr;  // angles about elongated poles, at even steps; or none

    [[nodiscard]] double across(std::size_t line) const {
        const double t = (static_cast<double>(line) + 0.5) / static_cast<double>(ACROSS);
        return first + t * (last - first);
    }
    [[nodiscard]] Point2 at(double s, std::size_t line) const {
        const double u = pieces.empty() ? s : unbent(pieces, s), v = across(line);
        return axis == 0 ? Point2{u, v} : Point2{v, u};
    }
    /// |r_u| or |r_v| of what was read.
    [[nodiscard]] double speed(std::size_t i) const { return norm(surface[1 + axis][i]); }
};

double length_between(Point3 a, Point3 b) { return norm(b - a); }

/// From the mean length of the way to parameters; both rise.
ChartAxis axis_of_length(std::span<const double> parameters, std::span<const double> length) {
    const MonotoneCubic spline(length, parameters);
    ChartAxis axis;
    axis.extent = length.back();
    const double step = axis.extent / static_cast<double>(KNOTS - 1);
    Array<double> x(KNOTS);
    axis.knots.resize(KNOTS);
    axis.slopes.resize(KNOTS);
    for (std::size_t k = 0; k < KNOTS; ++k) {
        x[k] = k + 1 < KNOTS ? static_cast<double>(k) * step : axis.extent;
        axis.knots[k] = spline.value(x[k]);
    }
    axis.knots[0] = parameters.front();
    axis.knots[KNOTS - 1] = parameters.back();
    // slopes of a monotone cubic on the even knots (Fritsch and Carlson 1980)
    const MonotoneCubic through_knots(x, axis.knots);
    for (std::size_t k = 0; k < KNOTS; ++k) axis.slopes[k] = through_knots.derivative(x[k]);
    return axis;
}

/// From mean speeds at even steps from low to high.
ChartAxis axis_of_speeds(double low, double high, Array<double> speed) {
    double average = mean(speed);
    if (!(average > 0.0)) {
        average = 1.0;
        speed.fill(1.0);
    }
    for (double& x : speed) x = std::max(x, SLOWEST * average);
    const auto [slowest, fastest] = std::minmax_element(speed.begin(), speed.end());
    if (*fastest <= UNEVEN * *slowest) return linear_axis(low, high, average);
    const double extent = average * (high - low);
    const std::size_t count = speed.size();
    Array<double> parameters(count), length(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(count - 1);
        parameters[k] = low + t * (high - low);
        length[k] = k == 0 ? 0.0 : length[k - 1] + 0.5 * (speed[k] + speed[k - 1]);
    }
    const double scale = extent / length[count - 1];
    for (double& x : length) x *= scale;
    length[count - 1] = extent;
    return axis_of_length(parameters, length);
}

/// From one line across, as the speed is the same all along the axis.
ChartAxis steady_axis(const Lines& lines) {
    Array<Point2> uv(ACROSS);
    for (std::size_t line = 0; line < ACROSS; ++line)
        uv[line] = lines.at(0.5 * (lines.low + lines.high), line);
    lines.surface.read(uv, 1);
    Array<double> speed(ACROSS);
    for (std::size_t line = 0; line < ACROSS; ++line) speed[line] = lines.speed(line);
    const double average = mean(speed);
    return linear_axis(lines.low, lines.high, average > 0.0 ? average : 1.0);
}

/// Points of all lines at s, those of one s together.
Array<Point3> points_at(const Lines& lines, std::span<const double> s) {
    Array<Point2> uv;
    uv.reserve(s.size() * ACROSS);
    for (const double x : s)
        for (std::size_t line = 0; line < ACROSS; ++line) uv.push_back(lines.at(x, line));
    lines.surface.read(uv, 0);
    return Array<Point3>(lines.surface[0]);
}

/// Mean length of the steps between points of all lines.
Array<double> mean_steps(const Array<Point3>& r) {
    Array<double> steps;
    for (std::size_t k = ACROSS; k < r.size(); k += ACROSS) {
        double length[ACROSS];
        for (std::size_t line = 0; line < ACROSS; ++line)
            length[line] = length_between(r[k + line - ACROSS], r[k + line]);
        steps.push_back(mean(length));
    }
    return steps;
}

/// Halve steps, of which there is one before each of the places: s and r in their order.
void halve(const Lines& lines, std::span<const std::uint8_t> is_long, Array<double>& s,
           Array<Point3>& r) {
    Array<double> middle;
    for (std::size_t k = 0; k < is_long.size(); ++k)
        if (is_long[k] != 0) middle.push_back(0.5 * (s[k] + s[k + 1]));
    const Array<Point3> between = points_at(lines, middle);
    Array<double> all_s;
    Array<Point3> all_r;
    std::size_t next = 0;
    for (std::size_t k = 0; k < s.size(); ++k) {
        if (k > 0 && is_long[k - 1] != 0) {
            all_s.push_back(middle[next]);
            for (std::size_t line = 0; line < ACROSS; ++line)
                all_r.push_back(between[next * ACROSS + line]);
            ++next;
        }
        all_s.push_back(s[k]);
        for (std::size_t line = 0; line < ACROSS; ++line) all_r.push_back(r[k * ACROSS + line]);
    }
    s = std::move(all_s);
    r = std::move(all_r);
}

/// From mean lengths of chords over lines across, between parameters that are close where the
/// surface is fast.
ChartAxis axis_of_chords(const Lines& lines) {
    const double range = lines.high - lines.low;
    const std::size_t count = lines.samples;
    Array<double> s(count);
    for (std::size_t k = 0; k < count; ++k)
        s[k] = lines.low + static_cast<double>(k) * (range / static_cast<double>(count - 1));
    s[count - 1] = lines.high;
    Array<Point3> r = points_at(lines, s);
    Array<double> steps = mean_steps(r);
    double total = pairwise_sum(steps);
    while (s.size() <= MOST_STEPS) {
        Array<std::uint8_t> is_long(steps.size());
        for (std::size_t k = 0; k < steps.size(); ++k)
            is_long[k] = steps[k] > LONG_STEP * total && s[k + 1] - s[k] > FINEST_STEP * range;
        if (std::find(is_long.begin(), is_long.end(), 1) == is_long.end()) break;
        halve(lines, is_long, s, r);
        steps = mean_steps(r);
        total = pairwise_sum(steps);
    }
    Array<double> length(s.size());
    length[0] = 0.0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const double least = SLOWEST * total * (s[k + 1] - s[k]) / range;
        length[k + 1] = length[k] + std::max(steps[k], least);
    }
    return axis_of_length(s, length);
}

/// The axis by the angle about its poles, and a little by length, so that it never stops.
void mix_in(const Array<double>& angles, Array<double>& speed) {
    const std::size_t last = speed.size() - 1;
    const double average = mean(speed);
    const double by_angle = average * static_cast<double>(last) / (angles[last] - angles[0]);
    for (std::size_t k = 0; k <= last; ++k) {
        const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, last);
        const double rate = (angles[after] - angles[before]) / static_cast<double>(after - before);
        speed[k] = BY_LENGTH * speed[k] + (1.0 - BY_LENGTH) * by_angle * rate;
    }
}

/// From speeds on lines across and along, or from chords where the speeds miss something.
ChartAxis sampled_axis(const Lines& lines) {
    const double range = lines.high - lines.low;
    const std::size_t count = lines.samples;
    Array<Point2> uv(ACROSS * count);
    Array<double> rate(count, 1.0);
    for (std::size_t k = 0; k < count; ++k) {
        const double s =
            lines.low + static_cast<double>(k) / static_cast<double>(count - 1) * range;
        if (!lines.pieces.empty()) rate[k] = rate_of_bending(lines.pieces, s);
        for (std::size_t line = 0; line < ACROSS; ++line) uv[line * count + k] = lines.at(s, line);
    }
    lines.surface.read(uv, 1);
    Array<double> speed(count, 0.0), ways(ACROSS), steps(count - 1), both(count - 1);
    for (std::size_t line = 0; line < ACROSS; ++line) {
        const auto r = lines.surface[0].subspan(line * count, count);
        for (std::size_t k = 0; k < count; ++k) speed[k] += lines.speed(line * count + k) * rate[k];
        for (std::size_t k = 0; k + 1 < count; ++k) steps[k] = length_between(r[k], r[k + 1]);
        ways[line] = pairwise_sum(steps);
    }
    for (double& x : speed) x /= static_cast<double>(ACROSS);
    for (std::size_t k = 0; k + 1 < count; ++k) both[k] = speed[k + 1] + speed[k];
    const double seen = pairwise_sum(both) * 0.5 * range / static_cast<double>(count - 1);
    const double way = mean(ways);
    if (lines.turned != nullptr) mix_in(*lines.turned, speed);
    if (std::max(seen, way) <= MISSED * std::min(seen, way))
        return axis_of_speeds(lines.low, lines.high, std::move(speed));
    return axis_of_chords(lines);
}

}  // namespace

ChartAxis linear_axis(double low, double high, double speed) {
    ChartAxis axis;
    axis.extent = speed * (high - low);
    for (const double knot : {low, high}) {
        axis.knots.push_back(knot);
        axis.slopes.push_back(1.0 / speed);
    }
    return axis;
}

Chart chart_of(SurfaceReader& surface, const std::array<KnownAxis, 2>& known, bool to_poles) {
    const auto [low, high] = surface.domain();
    const double ends[2][2] = {{low.x, high.x}, {low.y, high.y}};
    const auto lines_along = [&](std::size_t k) {
        const auto& [first, last] = ends[k];
        const auto& [left, right] = ends[1 - k];
        return Lines{surface, k, known[k].pieces, first, last, left, right, known[k].samples};
    };
    const auto axis_along = [&](std::size_t k, const Lines& lines) {
        const bool steady = known[k].steady && lines.pieces.empty();
        ChartAxis axis = steady ? steady_axis(lines) : sampled_axis(lines);
        axis.pieces = lines.pieces;
        return axis;
    };
    Chart made{axis_along(0, lines_along(0)), axis_along(1, lines_along(1))};
    if (!to_poles) return made;
    const std::optional<ElongatedPoles> poles = find_elongated_poles(surface, made);
    if (!poles) return made;
    const std::size_t around = 1 - poles->axis;
    if (known[around].pieces.empty() && !known[around].steady) {
        Lines lines = lines_along(around);
        lines.samples = poles->turned.size();
        lines.turned = &poles->turned;
        (around == 0 ? made.u : made.v) = axis_along(around, lines);
    }
    made.scaling = scaling_by(surface, made, *poles);
    return made;
}

}  // namespace surfmesh
