#include "intersection/tracing.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh {
namespace {

// radians between the tangents of neighbouring points, at most; below the second, steps grow
constexpr double TURN = 0.16, STRAIGHTER = 0.08;
constexpr double GROWN = 1.5, LARGEST = 4.0;  // of the step before, of the first step
constexpr double AHEAD = 1.6;                 // steps ahead in which ends are looked for
constexpr double ALIKE = 0.45;       // sine, and relative error in (u, v): an end straight ahead
constexpr double LEAST_STEP = 1e-7;  // of the first step: shorter ones lead nowhere
constexpr double BESIDE = 0.1;  // of the longer side of the box of a step: how much wider it is
constexpr double FLAT = 1e-7;   // sine of the angle between tangent planes: surfaces touch
constexpr double SHORTEST = 0.8, LONGEST = 1.25;  // of the step: how far it may lead
constexpr double SAME = 1e-6;                     // of the distance: an end as near as the best
constexpr std::size_t MOST_POINTS = 20000, FEWEST = 3;
constexpr double LEAST_SINE = 1e-300;

/// A point of a branch with its places.
struct BranchPoint {
    Point3 point;
    Point2 uv_a, uv_b;
};

class BranchTracer {
  public:
    BranchTracer(MeetingSurfaces& surfaces, const TraceEnd& start, std::span<const TraceEnd> ends,
                 const TraceSettings& settings)
        : surfaces_(surfaces), ends_(ends), settings_(settings) {
        if (start.singular) singular_.push_back(start.point);
        for (const TraceEnd& end : ends)
            if (end.singular) singular_.push_back(end.point);
        add({start.point, start.uv_a, start.uv_b});
        way_ = start.way;
    }

    TracedBranch trace(StartRates rates) {
        double step = settings_.step;
        const double grow = elementary::cos(STRAIGHTER);
        while (branch_.points.size() < MOST_POINTS && !surfaces_.failed()) {
            const bool looks = !settings_.closed || branch_.points.size() > FEWEST;
            const std::optional<std::size_t> end =
                looks ? end_ahead(AHEAD * step) : std::optional<std::size_t>();
            if (end) {
                finish(*end);
                break;
            }
            const Point3 before = way_;
            if (!go(step, rates)) {
                step *= 0.5;
                if (step < LEAST_STEP * settings_.step) break;
                continue;
            }
            rates = {};
            if (dot(before, way_) > grow) step = std::min(step * GROWN, LARGEST * settings_.step);
        }
        return std::move(branch_);
    }

  private:
    void add(const BranchPoint& at) {
        here_ = at;
        branch_.points.push_back(at.point);
        branch_.uv_a.push_back(at.uv_a);
        branch_.uv_b.push_back(at.uv_b);
    }

    void finish(std::size_t number) {
        const TraceEnd& end = ends_[number];
        if (branch_.points.size() < FEWEST) insert_between(end);  // enough points for a curve
        add({end.point, end.uv_a, end.uv_b});
        branch_.found = true;
        branch_.end = number;
    }

    /// Take the step ahead and turn into the tangent there; false where that is too far.
    bool go(double step, const StartRates& rates) {
        read({here_.uv_a, here_.uv_b}, 1);
        const Point2 along_a = rates.a.value_or(rates_along(surfaces_.a, 0, way_));
        const Point2 along_b = rates.b.value_or(rates_along(surfaces_.b, 0, way_));
        const Point2 guess_a = here_.uv_a + step * along_a, guess_b = here_.uv_b + step * along_b;
        const Point3 through = here_.point + step * way_;
        const CommonPoints found = pull_onto_both(surfaces_, {&guess_a, 1}, {&guess_b, 1},
                                                  {{&way_, 1}, {&through, 1}, {}});
        if (!(found.gap[0] <= settings_.gap)) return false;
        read({found.uv_a[0], found.uv_b[0]}, 1);
        const Point3 cross_ = cross(unit_normal(surfaces_.a, 0), unit_normal(surfaces_.b, 0));
        const double sine = norm(cross_);
        Point3 tangent = (1.0 / std::max(sine, LEAST_SINE)) * cross_;
        if (dot(tangent, way_) < 0.0) tangent = -1.0 * tangent;
        const double length = norm(found.point[0] - here_.point);
        const bool fits = sine > FLAT && dot(tangent, way_) > elementary::cos(TURN) &&
                          SHORTEST * step < length && length < LONGEST * step;
        if (!fits) return false;
        const BranchPoint next{found.point[0], found.uv_a[0], found.uv_b[0]};
        if (!is_near_singular() && !is_one_curve(next.uv_a, next.uv_b)) return false;
        add(next);
        way_ = tangent;
        return true;
    }

    /// The nearest end within reach that lies straight ahead and is entered the same way; of
    /// several that leave one branch point the one straight ahead.
    std::optional<std::size_t> end_ahead(double reach) {
        std::optional<std::size_t> best;
        double nearest = reach, aslant = 1.0;
        for (std::size_t k = 0; k < ends_.size(); ++k) {
            const TraceEnd& end = ends_[k];
            const Point3 step = end.point - here_.point;
            const double distance = norm(step);
            const double same = settings_.gap + SAME * distance;
            if (!(same < distance && distance <= nearest + same) || dot(step, way_) <= 0.0)
                continue;
            const double sine = norm(cross((1.0 / distance) * step, way_));
            const double turned = norm(cross(end.way, way_));
            if (sine > ALIKE || turned > 2.0 * ALIKE || dot(end.way, way_) >= 0.0) continue;
            if (!leads_to(end, step)) continue;
            if (best && distance > nearest - same && sine + turned >= aslant) continue;
            best = k;
            nearest = distance;
            aslant = sine + turned;
        }
        return best;
    }

    /// Do the ways in (u, v) lead to an end, and to no other branch?
    bool leads_to(const TraceEnd& end, Point3 step) {
        read({0.5 * (here_.uv_a + end.uv_a), 0.5 * (here_.uv_b + end.uv_b)}, 1);
        const auto is_straight = [&](const SurfaceReader& surface, Point2 way) {
            const Point3 led = way.x * surface[1][0] + way.y * surface[2][0];
            return norm(led - step) <= ALIKE * norm(step);
        };
        if (!is_straight(surfaces_.a, end.uv_a - here_.uv_a) ||
            !is_straight(surfaces_.b, end.uv_b - here_.uv_b))
            return false;
        return (end.singular && is_near_singular()) || is_one_curve(end.uv_a, end.uv_b);
    }

    /// Is a branch point or pole so near that normals tell nothing?
    [[nodiscard]] bool is_near_singular() const {
        return std::any_of(singular_.begin(), singular_.end(), [&](Point3 other) {
            return norm(here_.point - other) <= settings_.step;
        });
    }

    /// Are no normals parallel over the boxes from here to there? Then one curve passes.
    bool is_one_curve(Point2 uv_a, Point2 uv_b) {
        const CellBounds a = bounds_of_way(surfaces_.a, here_.uv_a, uv_a);
        const CellBounds b = bounds_of_way(surfaces_.b, here_.uv_b, uv_b);
        return cross_surely(view_of(a), 0, view_of(b), 0);
    }

    static CellBounds bounds_of_way(SurfaceReader& surface, Point2 start, Point2 end) {
        const Point2 low{std::min(start.x, end.x), std::min(start.y, end.y)};
        const Point2 high{std::max(start.x, end.x), std::max(start.y, end.y)};
        const double room = BESIDE * std::max(high.x - low.x, high.y - low.y);
        const ParameterBox cell{low - Point2{room, room}, high + Point2{room, room}};
        return bound_cells(surface, {&cell, 1});
    }

    /// Two points more on a very short branch.
    void insert_between(const TraceEnd& end) {
        const BranchPoint first = here_;
        const Point3 chord = end.point - first.point;
        const Point3 normal = (1.0 / norm(chord)) * chord;
        for (const double t : {1.0 / 3.0, 2.0 / 3.0}) {
            const Point3 through = (1.0 - t) * first.point + t * end.point;
            const Point2 guess_a = (1.0 - t) * first.uv_a + t * end.uv_a;
            const Point2 guess_b = (1.0 - t) * first.uv_b + t * end.uv_b;
            const CommonPoints found = pull_onto_both(surfaces_, {&guess_a, 1}, {&guess_b, 1},
                                                      {{&normal, 1}, {&through, 1}, {}});
            if (found.gap[0] <= settings_.gap) add({found.point[0], found.uv_a[0], found.uv_b[0]});
        }
    }

    void read(std::array<Point2, 2> uv, int order) {
        surfaces_.a.read({uv.data(), 1}, order);
        surfaces_.b.read({uv.data() + 1, 1}, order);
    }

    MeetingSurfaces& surfaces_;
    std::span<const TraceEnd> ends_;
    TraceSettings settings_;
    Array<Point3> singular_;
    BranchPoint here_{};
    Point3 way_{};
    TracedBranch branch_{false, 0, {}, {}, {}};
};

}  // namespace

Point3 unit_normal(const SurfaceReader& surface, std::size_t row) {
    const Point3 normal = cross(surface[1][row], surface[2][row]);
    return (1.0 / std::max(norm(normal), LEAST_SINE)) * normal;
}

Point2 rates_along(const SurfaceReader& surface, std::size_t row, Point3 way) {
    const Point3 r_u = surface[1][row], r_v = surface[2][row];
    const double e = dot(r_u, r_u), f = dot(r_u, r_v), g = dot(r_v, r_v);
    const double a = dot(r_u, way), b = dot(r_v, way);
    const double determinant = std::max(e * g - f * f, LEAST_SINE);
    return {(g * a - f * b) / determinant, (e * b - f * a) / determinant};
}

TracedBranch trace_branch(MeetingSurfaces& surfaces, const TraceEnd& start, const StartRates& rates,
                          std::span<const TraceEnd> ends, const TraceSettings& settings) {
    return BranchTracer(surfaces, start, ends, settings).trace(rates);
}

namespace {

constexpr std::size_t NEAREST = 3;    // segments that a point is compared with
constexpr double NEAR_SEGMENT = 0.1;  // of its length: a branch bends off its chords no farther

/// A segment near a point, the fraction of its foot, and the distance.
struct NearSegment {
    std::size_t segment;
    double t, distance;
};

/// The nearest segments of a branch, nearest first, so far as these are near at all.
Array<NearSegment> near_segments(const BranchView& branch, Point3 point) {
    Array<NearSegment> best;
    for (std::size_t k = 0; k + 1 < branch.points.size(); ++k) {
        const Point3 p = branch.points[k], step = branch.points[k + 1] - p;
        const double square = dot(step, step);
        const double t = std::clamp(square > 0.0 ? dot(point - p, step) / square : 0.0, 0.0, 1.0);
        const double distance = norm(p + t * step - point);
        if (best.size() == NEAREST && distance >= best.back().distance) continue;
        if (best.size() == NEAREST) best.pop_back();
        best.push_back({k, t, distance});
        for (auto i = static_cast<std::ptrdiff_t>(best.size()) - 1;
             i > 0 && best[i].distance < best[i - 1].distance; --i)
            std::swap(best[i], best[i - 1]);
    }
    Array<NearSegment> found;
    for (const NearSegment& own : best)
        if (own.distance <=
            NEAR_SEGMENT * norm(branch.points[own.segment + 1] - branch.points[own.segment]))
            found.push_back(own);
    return found;
}

}  // namespace

Array<std::uint8_t> lie_on_branch(MeetingSurfaces& surfaces, const BranchView& branch,
                                  std::span<const Point3> points, double tolerance) {
    Array<std::size_t> owner;
    Array<Point2> guess_a, guess_b;
    Array<Point3> normal, through;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (const auto& [k, t, distance] : near_segments(branch, points[i])) {
            const Point3 step = branch.points[k + 1] - branch.points[k];
            owner.push_back(i);
            guess_a.push_back(branch.uv_a[k] + t * (branch.uv_a[k + 1] - branch.uv_a[k]));
            guess_b.push_back(branch.uv_b[k] + t * (branch.uv_b[k + 1] - branch.uv_b[k]));
            normal.push_back((1.0 / norm(step)) * step);
            through.push_back(points[i]);
        }
    const std::size_t count = owner.size();
    const CommonPoints found =
        pull_onto_both(surfaces, {guess_a.data(), count}, {guess_b.data(), count},
                       {{normal.data(), count}, {through.data(), count}, {}});
    Array<std::uint8_t> on(points.size(), std::uint8_t{0});
    for (std::size_t k = 0; k < count; ++k) {
        const auto row = static_cast<std::ptrdiff_t>(k);
        if (norm(found.point[row] - through[row]) <= tolerance)
            on[static_cast<std::ptrdiff_t>(owner[row])] = 1;
    }
    return on;
}

}  // namespace surfmesh
