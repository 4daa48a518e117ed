#include "patch/even_use.hpp"

#include <utility>

#include "optimisation/marked_triangles.hpp"
#include "patch/tracked_deviations.hpp"

namespace surfmesh {
namespace {

constexpr int PASSES = 20, PASSES_AFTER_INSERTION = 4;
// Where the surface turns over, moves bring others far again: the last rounds do without.
constexpr int ROUNDS = 12, MOVING_ROUNDS = 7;

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

class EvenUse {
  public:
    explicit EvenUse(PatchState& state)
        : state_(state), chord_(*state.asked().chord), tracked_(state, chord_) {}

    Triangles in_rounds(bool first) {
        even_all();
        Triangles far = beyond(TOO_FAR, tracked_.suspects());
        if (first && static_cast<double>(far.size()) > MANY_FAR_EVENLY * state_.t.triangles())
            return far;
        state_.allow_splits();
        return beyond(LET_PASS, insert_far(std::move(far)));
    }

  private:
    void even_all() {
        const double kept = std::exchange(state_.kept_drift, KEPT_OFF);
        state_.marks.active.fill(1);
        for (int pass = 0; pass < PASSES; ++pass) {
            state_.even_deviations(AIMED_AT * chord_);
            if (state_.moved.empty()) break;
        }
        state_.settle();
        state_.kept_drift = kept;
    }

    /// Insert vertices at the farthest of the triangles, and move those around; returns those left.
    Triangles insert_far(Triangles far) {
        for (int round = 0; round < ROUNDS && !far.empty() && !state_.stopped(); ++round) {
            tracked_.start_round();
            state_.marks.active.fill(0);
            if (state_.split_farthest(farthest_of(far)) == 0) break;
            for (int pass = 0; pass < PASSES_AFTER_INSERTION && round < MOVING_ROUNDS; ++pass) {
                if (pass % 2 == 0) state_.swap(SWAPPED_BELOW);
                state_.even_deviations(AIMED_AT * chord_);
                tracked_.add_moved();
            }
            far = beyond(TOO_FAR, tracked_.changed(far));
        }
        return far;
    }

    /// The upper half of what the farthest exceed the limit by: what is inserted there brings others
    /// near.
    Triangles farthest_of(const Triangles& far) {
        const Array<double> found = tracked_.measure(far);
        const double most = *std::max_element(found.begin(), found.end());
        return those_above(0.5 * (TOO_FAR * chord_ + most), far, found);
    }
    Triangles beyond(double part, const Triangles& suspects) {
        return those_above(part * chord_, suspects, tracked_.measure(suspects));
    }
    static Triangles those_above(double limit, const Triangles& triangles,
                                 const Array<double>& distance) {
        Triangles found;
        for (std::size_t k = 0; k < triangles.size(); ++k)
            if (distance[k] > limit) found.push_back(triangles[k]);
        return found;
    }

    PatchState& state_;
    double chord_;
    TrackedDeviations tracked_;
};

}  // namespace

Triangles approach_evenly(PatchState& state, bool first) {
    return EvenUse(state).in_rounds(first);
}

}  // namespace surfmesh
