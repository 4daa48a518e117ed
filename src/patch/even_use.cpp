#include "patch/even_use.hpp"

#include <algorithm>
#include <utility>

#include "optimisation/marked_triangles.hpp"
#include "patch/tracked_deviations.hpp"

namespace surfmesh {
namespace {

constexpr int PASSES = 20, PASSES_AFTER_INSERTION = 4;
// Where the surface turns over, even moves bring others far again: the last rounds do without.
constexpr int ROUNDS = 12, EVEN_ROUNDS = 7, ROUNDS_AT_LAST = 8;
constexpr int RAISING_ROUNDS = 3;

// Vertices are inserted at this part of the triangles that are too far in each round, and where they
// are that much too far.
constexpr double FARTHEST_PART = 0.2, CLEARLY_TOO_FAR = 1.07;

// In the end corners of triangles below the first alpha move once more, to bring it to the second.
constexpr double BAD_SHAPE_AT_LAST = 0.78, LEAST_AT_LAST = 0.82;

// Of the triangles: where more are too far at first, the field was wrong, and a finer one needs fewer
// of them than insertions.
constexpr double MANY_FAR_EVENLY = 0.2;

// Of ``chord``: what moves aim at by the estimate, which knows sides and centre; from where triangles
// are too far; what is let pass in the end, as ``approach_surface`` has them.
constexpr double AIMED_AT = 0.93, TOO_FAR = 0.97, LET_PASS = 0.985;

constexpr double SWAPPED_BELOW = 0.9;  // alpha of triangles whose edges are looked at

// In unit lengths: vertices that have moved by less are not put on the surface between the passes.
constexpr double KEPT_OFF = 0.05;

using Triangles = Array<Triangle>;

/// Move all vertices until none is to move any more, or often.
void even_all(PatchState& state, double allowed) {
    const double kept = std::exchange(state.kept_drift, KEPT_OFF);
    state.marks.active.fill(1);
    for (int pass = 0; pass < PASSES; ++pass) {
        state.even_deviations(allowed);
        if (state.moved.empty()) break;
    }
    state.settle();
    state.kept_drift = kept;
}

/// Triangles that are too far from the surface, and their rounds.
class EvenUse {
  public:
    explicit EvenUse(PatchState& state)
        : state_(state), chord_(*state.asked().chord), tracked_(state, chord_) {}

    Triangles in_rounds(bool first) {
        Triangles far = beyond(TOO_FAR, tracked_.suspects());
        if (first && static_cast<double>(far.size()) > MANY_FAR_EVENLY * state_.t.triangles())
            return far;
        state_.allow_splits();
        far = insert_far(std::move(far), ROUNDS);
        far = insert_far(raise_bad(std::move(far)), ROUNDS_AT_LAST);
        return beyond(LET_PASS, far);
    }

  private:
    /// Insert vertices at the farthest of the triangles, and move those around; returns those left.
    Triangles insert_far(Triangles far, int rounds) {
        for (int round = 0; round < rounds && !far.empty() && !state_.stopped(); ++round) {
            tracked_.start_round();
            state_.marks.active.fill(0);
            if (state_.split_farthest(farthest_of(far)) == 0) break;
            for (int pass = 0; pass < PASSES_AFTER_INSERTION && round < EVEN_ROUNDS; ++pass) {
                if (pass % 2 == 0) state_.swap(SWAPPED_BELOW);
                state_.even_deviations(AIMED_AT * chord_);
                tracked_.add_moved();
            }
            far = beyond(TOO_FAR, tracked_.changed(far));
            if (round >= EVEN_ROUNDS) far = moved_nearer(std::move(far));
        }
        return far;
    }

    /// Move corners of triangles of bad shape, be they ``far`` or not; returns those left that are far.
    Triangles raise_bad(Triangles far) {
        for (int round = 0; round < RAISING_ROUNDS && !state_.stopped(); ++round) {
            const Triangles bad = triangles_below(state_.t, state_.frames, BAD_SHAPE_AT_LAST);
            if (bad.empty()) break;
            far = moved_nearer(std::move(far), bad);
        }
        return far;
    }

    /// Move corners of some triangles, or of those that are too far, while that brings their stars
    /// nearer, or to better shapes; returns those left that are too far.
    Triangles moved_nearer(Triangles far, const Triangles& which) {
        if (which.empty() || state_.stopped()) return far;
        tracked_.start_round();
        state_.bring_nearer(which, {AIMED_AT * chord_, LEAST_AT_LAST});
        tracked_.add_moved();
        return beyond(TOO_FAR, tracked_.changed(far));
    }
    Triangles moved_nearer(Triangles far) {
        const Triangles which(far);
        return moved_nearer(std::move(far), which);
    }

    /// The farthest of the triangles: what is inserted there brings others near.
    Triangles farthest_of(const Triangles& far) {
        const Array<double> found = tracked_.measure(far);
        Array<double> sorted(found);
        const double others = (1.0 - FARTHEST_PART) * static_cast<double>(sorted.size());
        double* const least = sorted.begin() + static_cast<std::ptrdiff_t>(others);
        std::nth_element(sorted.begin(), least, sorted.end());
        const double clearly = CLEARLY_TOO_FAR * chord_;
        return those_from(std::min(*least, clearly), far, found);
    }
    Triangles beyond(double part, const Triangles& suspects) {
        return those_from(part * chord_, suspects, tracked_.measure(suspects));
    }
    static Triangles those_from(double limit, const Triangles& triangles,
                                const Array<double>& distance) {
        Triangles found;
        for (std::size_t k = 0; k < triangles.size(); ++k)
            if (distance[k] >= limit) found.push_back(triangles[k]);
        return found;
    }

    PatchState& state_;
    double chord_;
    TrackedDeviations tracked_;
};

}  // namespace

Triangles approach_evenly(PatchState& state, bool first) {
    const double chord = *state.asked().chord;
    if (TrackedDeviations(state, chord).suspects().empty()) return {};
    even_all(state, AIMED_AT * chord);
    return EvenUse(state).in_rounds(first);
}

}  // namespace surfmesh
