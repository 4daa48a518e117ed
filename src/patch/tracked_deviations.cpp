#include "patch/tracked_deviations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "optimisation/marked_triangles.hpp"
#include "patch/findings.hpp"
#include "values/first_touch.hpp"

namespace surfmesh {
namespace {

// Fraction of ``chord`` from which the estimate of a triangle's deviation is not trusted.
constexpr double SUSPECT_PART = 0.82, SUSPECT_PART_STRETCHED = 0.7;

// The same of an estimate times the factor of a measurement before. On two_peaks and wavy, of
// 250,000 such triangles after moves not one that was too far came out below 0.93 of ``chord``.
constexpr double SUSPECT_ONCE_MEASURED = 0.9;

// Up to so many all are measured whose estimate is no round-off, as a fraction of ``chord``: the
// estimate is for triangles small beside the features.
constexpr std::size_t FEW_TRIANGLES = 20'000;
constexpr double FLAT = 1e-9;
// Of ``chord``: from where the farthest are taken before others.
constexpr double CLEARLY_FAR = 1.05;

// Where ``min_size`` binds nothing is split: a triangle is left alone that would be so much too large
// still if its size were the smallest, since moves make good less.
constexpr double BEYOND_MOVES = 0.9;

constexpr std::size_t TRIANGLES_TOGETHER = 1 << 15;  // triangles looked through together
constexpr std::size_t MEASURED_TOGETHER = 1 << 12;   // whose factors are found together
constexpr std::size_t CORNERS_COMPARED = 1 << 10;    // with those before at once

/// So many vertices there may be after all splits.
std::size_t with_room(const PatchState& state) { return state.t.xy.size() + state.t.xy.size() / 4; }

double estimate(const PatchState& state, Triangle k) {
    const Array<Vertex>& tri = state.t.tri;
    return triangle_deviation(state.frames, tri[3 * k], tri[3 * k + 1], tri[3 * k + 2]);
}

/// The size that triangles are held at, 0 for none. Stretched ones are not: turned and moved on they
/// come two to three times nearer to the surface, whatever their size.
double least_held(const PatchState& state) {
    return state.is_anisotropic() ? 0.0 : state.asked().min_size;
}

/// Is a triangle with this deviation far because its size is not to be below ``min_size``?
bool is_held_by_min_size(const PatchState& state, Triangle k, double deviation, double chord) {
    const double least = least_held(state);
    if (!(least > 0.0 && deviation > chord)) return false;
    double size = 0.0;  // the largest that the field has at a corner
    for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
        const Vertex v = state.t.tri[e];
        size = std::max(size, state.frames.size[v] / state.frames.scale[v]);
    }
    return WORTH_A_ROUND * size <= least &&
           size * std::sqrt(chord / deviation) < BEYOND_MOVES * least;
}

}  // namespace

Array<Triangle> farther_than(double limit, const Array<Triangle>& triangles,
                             const Array<double>& deviation) {
    Array<Triangle> found;
    for (std::size_t k = 0; k < triangles.size(); ++k)
        if (deviation[k] > limit) found.push_back(triangles[k]);
    return found;
}

TrackedDeviations::TrackedDeviations(PatchState& state, double chord)
    : state_(state), chord_(chord), looked_at_(chord) {
    const bool few = state.t.region.size() <= FEW_TRIANGLES;
    const double one_sided = state.is_anisotropic() ? SUSPECT_PART_STRETCHED : SUSPECT_PART;
    const double part = state.asked().is_width ? 0.5 * one_sided : one_sided;
    suspect_ = (few ? FLAT : part) * chord;
    suspect_once_measured_ = few ? suspect_ : SUSPECT_ONCE_MEASURED * chord;
    factor_ = filled_by_threads(state.t.region.size(), 0.0F, 2 * with_room(state));
}

bool TrackedDeviations::is_suspect(Triangle k) const {
    const double factor = factor_[k], guess = estimate(state_, k);
    return factor > 0.0 ? factor * guess > suspect_once_measured_ : guess > suspect_;
}

Array<Triangle> TrackedDeviations::suspects() const {
    return collect_by_blocks<Triangle>(
        state_.t.region.size(), TRIANGLES_TOGETHER,
        [&](std::size_t first, std::size_t last, Array<Triangle>& found) {
            for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k)
                if (state_.t.region[k] != DEAD && is_suspect(k)) found.push_back(k);
        });
}

Array<double> TrackedDeviations::measure(const Array<Triangle>& triangles) {
    if (least_held(state_) > 0.0) return measure_free(triangles);
    return measure_all(triangles);
}

Array<double> TrackedDeviations::measure_all(const Array<Triangle>& triangles) {
    Array<double> found = deviations(state_, triangles, looked_at_);
    for_each_block(triangles.size(), MEASURED_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            const double guess = estimate(state_, triangles[k]);
            factor_[triangles[k]] = guess > 0.0 ? static_cast<float>(found[k] / guess) : 0.0F;
        }
    });
    return found;
}

Array<double> TrackedDeviations::measure_free(const Array<Triangle>& triangles) {
    Array<Triangle> free;
    Array<std::size_t> place;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        if (is_held(triangles[k])) continue;
        free.push_back(triangles[k]);
        place.push_back(k);
    }
    const Array<double> of_free = measure_all(free);
    Array<double> found(triangles.size(), 0.0);
    for (std::size_t k = 0; k < free.size(); ++k)
        if (!is_held_by_min_size(state_, free[k], of_free[k], chord_)) found[place[k]] = of_free[k];
    return found;
}

bool TrackedDeviations::is_held(Triangle k) const {
    const double factor = factor_[k] > 0.0F ? factor_[k] : 1.0;
    return is_held_by_min_size(state_, k, factor * estimate(state_, k), chord_);
}

Array<Triangle> TrackedDeviations::held() {
    Array<Triangle> found;
    if (!(least_held(state_) > 0.0)) return found;
    const Array<Triangle> near = suspects();
    const Array<double> deviation = measure_all(near);
    for (std::size_t k = 0; k < near.size(); ++k)
        if (is_held_by_min_size(state_, near[k], deviation[k], chord_)) found.push_back(near[k]);
    return found;
}

Array<Triangle> TrackedDeviations::farther(const Array<Triangle>& triangles, double limit) {
    return farther_than(limit, triangles, measure(triangles));
}

Array<Triangle> TrackedDeviations::farthest(const Array<Triangle>& triangles, double limit) {
    const Array<double> error = measure(triangles);
    double most = 0.0;
    for (const double e : error) most = std::max(most, e);
    const bool is_clear = most > CLEARLY_FAR * chord_;
    return farther_than(is_clear ? 0.5 * (limit + most) : limit, triangles, error);
}

void TrackedDeviations::start_round() {
    if (edges_before_ != state_.edge_changes) note_corners();
    is_changed_.fill(0);
}

void TrackedDeviations::note_corners() {
    const Array<Vertex>& now = state_.t.tri;  // into the memory of the round before
    if (before_.empty()) before_ = unfilled_with_room<Vertex>(now.size(), 6 * with_room(state_));
    before_.resize(now.size());
    for_each_block(now.size(), 3 * TRIANGLES_TOGETHER, [&](std::size_t first, std::size_t last) {
        std::copy(now.begin() + first, now.begin() + last, before_.begin() + first);
    });
    edges_before_ = state_.edge_changes;
}

void TrackedDeviations::add_moved() {
    is_changed_.resize(state_.t.xy.size(), 0);
    for (const Vertex v : state_.moved) is_changed_[v] = 1;
}

/// The half-edges that start elsewhere than when the round began.
Array<HalfEdge> TrackedDeviations::new_corners() const {
    const Array<Vertex>& now = state_.t.tri;
    if (edges_before_ == state_.edge_changes) return {};
    return collect_by_blocks<HalfEdge>(
        now.size(), CORNERS_COMPARED,
        [&](std::size_t first, std::size_t last, Array<HalfEdge>& own) {
            if (std::equal(now.begin() + first, now.begin() + last, before_.begin() + first))
                return;  // nearly always
            for (std::size_t e = first; e < last; ++e)
                if (now.data()[e] != before_.data()[e]) own.push_back(static_cast<HalfEdge>(e));
        });
}

Array<Triangle> TrackedDeviations::changed(const Array<Triangle>& others) {
    const Array<Vertex>& now = state_.t.tri;
    is_changed_.resize(state_.t.xy.size(), 0);
    factor_.resize(state_.t.region.size(), 0.0F);
    before_.resize(now.size(), NIL);  // of new triangles all corners are
    for (const HalfEdge e : new_corners()) {
        is_changed_[now[e]] = 1;
        factor_[e / 3] = 0.0F;
        before_[e] = now[e];
    }
    edges_before_ = state_.edge_changes;
    state_.find_stars();
    const Array<Triangle> around = triangles_at(state_.t, &state_.stars, is_changed_);
    const Array<Triangle> found =
        collect_by_blocks<Triangle>(around.size(), TRIANGLES_TOGETHER,
                                    [&](std::size_t first, std::size_t last, Array<Triangle>& own) {
                                        for (std::size_t k = first; k < last; ++k)
                                            if (is_suspect(around.data()[k]))
                                                own.push_back(around.data()[k]);
                                    });
    Array<Triangle> both(found.size() + others.size());
    Triangle* const last =
        std::set_union(found.begin(), found.end(), others.begin(), others.end(), both.begin());
    both.resize(static_cast<std::size_t>(last - both.begin()));
    return both;
}

}  // namespace surfmesh
