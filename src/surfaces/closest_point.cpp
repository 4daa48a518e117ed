#include "surfaces/closest_point.hpp"

#include <cmath>

#include "surfaces/fundamental_forms.hpp"
#include "surfaces/joined_sides.hpp"

namespace surfmesh {
namespace {

constexpr double CONVERGED = 1e-3;   // step over distance: below it that is right to 5e-7
constexpr double PARALLEL = 1e-12;   // squared sine of r_u and r_v: below, only the longer counts
constexpr double FROM_CORNER = 0.1;  // of the way to the foot so far: where a search begins anew
constexpr double SHORTER = 0.25;     // of a step that led farther from the point is tried next

/// A step in (u, v), and the squared length that it has in space.
struct Step {
    Point2 uv;
    double squared;
};

Step gauss_newton(Point3 ru, Point3 rv, Point3 gap) {
    const double E = lane_dot(ru, ru), F = lane_dot(ru, rv), G = lane_dot(rv, rv);
    const double a = lane_dot(ru, gap), b = lane_dot(rv, gap);
    const double determinant = E * G - F * F;
    Point2 step;
    if (determinant > PARALLEL * E * G)
        step = {(G * a - F * b) / determinant, (E * b - F * a) / determinant};
    else if (E >= G)  // at a pole or cusp: along the longer tangent alone
        step = {a / (E > 0.0 ? E : 1.0), 0.0};
    else
        step = {0.0, b / (G > 0.0 ? G : 1.0)};
    return {step, step.x * a + step.y * b};
}

Point2 clipped(Point2 p, const ParameterBox& box) {
    return {std::min(std::max(p.x, box.low.x), box.high.x),
            std::min(std::max(p.y, box.low.y), box.high.y)};
}

ParameterBox widened(const ParameterBox& box, double margin) {
    const Point2 by = margin * (box.high - box.low);
    return {box.low - by, box.high + by};
}

/// The search for many points at once: those that still go on.
class Search {
  public:
    Search(SurfaceReader& surface, std::span<const Point3> points, ClosestPoints& found,
           double margin, const JoinedSides& joined = {})
        : surface_(surface),
          points_(points),
          found_(found),
          box_(widened(surface.domain(), margin)),
          joined_(joined),
          squared_(points.size()) {}

    void start(std::span<const Point2> guesses) {
        surface_.read(guesses, 1);
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const Point3 gap = points_[i] - surface_[0][i];
            found_.foot[i] = surface_[0][i];
            squared_[i] = lane_dot(gap, gap);
            active_.push_back(static_cast<std::int32_t>(i));
            steps_.push_back(gauss_newton(surface_[1][i], surface_[2][i], gap));
        }
    }

    /// One step of the points that have not converged; false where there are none.
    bool advance(bool is_last) {
        keep_unconverged();
        if (active_.empty()) return false;
        surface_.read(trials_, is_last ? 0 : 1);
        for (std::size_t k = 0; k < active_.size(); ++k) judge(k, is_last);
        return true;
    }

    [[nodiscard]] double distance(std::size_t i) const { return std::sqrt(squared_[i]); }

  private:
    /// Of a place that a step leads to: across joined sides, no farther than others.
    [[nodiscard]] Point2 within(Point2 place) const {
        return clipped(joined_.crossed(place, surface_.domain()), box_);
    }

    /// And where their steps lead to. One that leads nowhere is the last: at walls, or shortened
    /// to round-off.
    void keep_unconverged() {
        std::size_t kept = 0;
        trials_.clear();
        for (std::size_t k = 0; k < active_.size(); ++k) {
            if (!(steps_[k].squared > CONVERGED * CONVERGED * squared_[active_[k]])) continue;
            const Point2 here = found_.uv[active_[k]], trial = within(here + steps_[k].uv);
            if (trial.x == here.x && trial.y == here.y) continue;
            trials_.push_back(trial);
            active_[kept] = active_[k];
            steps_[kept++] = steps_[k];
        }
        active_.resize(kept);
        steps_.resize(kept);
    }

    void judge(std::size_t k, bool is_last) {
        const std::int32_t i = active_[k];
        const Point3 foot = surface_[0][k], gap = points_[i] - foot;
        const double squared = lane_dot(gap, gap);
        if (!(squared < squared_[i])) {  // nan, too, where a formula ends
            steps_[k].uv = SHORTER * steps_[k].uv;
            return;
        }
        found_.uv[i] = trials_[k];
        found_.foot[i] = foot;
        squared_[i] = squared;
        if (!is_last) steps_[k] = gauss_newton(surface_[1][k], surface_[2][k], gap);
    }

    SurfaceReader& surface_;
    std::span<const Point3> points_;
    ClosestPoints& found_;
    ParameterBox box_;
    JoinedSides joined_;
    Array<double> squared_;
    Array<std::int32_t> active_;
    Array<Step> steps_;
    Array<Point2> trials_;
};

ClosestPoints searched(SurfaceReader& surface, std::span<const Point3> points,
                       std::span<const Point2> guesses, int steps, double margin,
                       const JoinedSides& joined) {
    ClosestPoints found{Array<Point2>(guesses), Array<double>(points.size()),
                        Array<Point3>(points.size())};
    Search search(surface, points, found, margin, joined);
    search.start(guesses);
    for (int remaining = steps - 1; remaining >= 0; --remaining)
        if (!search.advance(remaining == 0)) break;
    for (std::size_t i = 0; i < points.size(); ++i) found.distance[i] = search.distance(i);
    return found;
}

/// Of some points the places that another search has found, where these are nearer.
void take_nearer(const ClosestPoints& other, const Array<std::int32_t>& some,
                 ClosestPoints& found) {
    for (std::size_t k = 0; k < some.size(); ++k) {
        if (!(other.distance[k] < found.distance[some[k]])) continue;
        found.uv[some[k]] = other.uv[k];
        found.distance[some[k]] = other.distance[k];
        found.foot[some[k]] = other.foot[k];
    }
}

/// Is a place at a side of the box that no search leaves, or beyond it?
bool is_at_wall(Point2 p, const ParameterBox& box) {
    return !(p.x > box.low.x && p.x < box.high.x && p.y > box.low.y && p.y < box.high.y);
}

/// Search anew, across joined sides, for the points that are farther than ``limit`` or whose search
/// has ended at a wall.
void search_across_sides(SurfaceReader& surface, std::span<const Point3> points,
                         std::span<const Point2> guesses, double limit, int steps,
                         ClosestPoints& found) {
    Array<std::int32_t> far;
    Array<Point3> places;
    Array<Point2> from;
    const ParameterBox box = widened(surface.domain(), PROJECTION_MARGIN);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!(found.distance[i] > limit) && !is_at_wall(found.uv[i], box)) continue;
        far.push_back(static_cast<std::int32_t>(i));
        places.push_back(points[i]);
        from.push_back(guesses[i]);
    }
    if (far.empty()) return;
    const ClosestPoints other = closest_points_across_sides(surface, places, from, steps);
    take_nearer(other, far, found);
}

}  // namespace

ClosestPoints closest_points(SurfaceReader& surface, std::span<const Point3> points,
                             std::span<const Point2> guesses, int steps, double margin) {
    return searched(surface, points, guesses, steps, margin, {});
}

ClosestPoints closest_points_across_sides(SurfaceReader& surface, std::span<const Point3> points,
                                          std::span<const Point2> guesses, int steps) {
    const JoinedSides joined = joined_sides(surface);
    return searched(surface, points, guesses, steps, PROJECTION_MARGIN, joined);
}

ClosestPoints closest_points_in_triangles(SurfaceReader& surface, std::span<const Point3> points,
                                          std::span<const Point2> guesses,
                                          std::span<const ParameterTriangle> corners,
                                          std::span<const std::int64_t> triangle, double limit,
                                          int steps) {
    ClosestPoints found = closest_points(surface, points, guesses, steps);
    Array<std::int32_t> far;
    Array<Point3> places;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!(found.distance[i] > limit)) continue;
        far.push_back(static_cast<std::int32_t>(i));
        places.push_back(points[i]);
    }
    Array<Point2> anew(far.size());
    for (std::size_t corner = 0; corner < 3 && !far.empty(); ++corner) {
        for (std::size_t k = 0; k < far.size(); ++k) {  // the corner may be the singular point
            const Point2 from = corners[triangle[far[k]]][corner];
            anew[k] = from + FROM_CORNER * (found.uv[far[k]] - from);
        }
        const ClosestPoints other = closest_points(surface, places, anew, steps);
        take_nearer(other, far, found);
    }
    search_across_sides(surface, points, guesses, limit, steps, found);
    return found;
}

}  // namespace surfmesh
