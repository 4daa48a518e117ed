#include "patch/stretched_even_use.hpp"

#include <cmath>
#include <utility>

#include "patch/tracked_deviations.hpp"

namespace surfmesh {
namespace {

// Of ``chord``: from where triangles are evened out, and what they are evened out to, by the estimate.
constexpr double EVENED = 0.93, EVEN = 0.88;
constexpr int EVENING_ROUNDS = 4;
constexpr double ROUGHLY = 1.15;  // near it triangles have all samples then

// The same where they are too far: samples of the report may be a little farther than those here,
// and sides and centroid, which the estimate knows, up to 4.2 % nearer than places between them.
constexpr double FAR = 0.97, NEAR = 0.93;
constexpr int EVENED_SPLIT_ROUNDS = 10, MOVES_AFTER_SPLIT = 3;

constexpr double LEAST_EVENED_SHAPE =
    0.7;  // alpha in the metric that moves keep to, where they can

// At all triangles, in the end: places between the few samples of long ones, across a direction that
// turns, may be twice as far.
constexpr int LAST_LOOKS = 3;
constexpr double CLOSER = 0.5;

// Where more of the triangles are far in the first round a finer field needs fewer than splits.
constexpr double MANY_FAR_EVENED = 0.3;

using Triangles = Array<Triangle>;

/// Triangles that are to deviate alike, and their rounds.
class EvenDeviations {
  public:
    explicit EvenDeviations(PatchState& state)
        : state_(state), chord_(*state.asked().chord), tracked_(state, chord_) {}

    Triangles in_rounds(bool first);

  private:
    Triangles bring_nearer(Triangles far, int rounds, double aim, double limit);
    Triangles split_far(Triangles far);
    [[nodiscard]] bool has_far_side(Triangle k) const;
    [[nodiscard]] Triangles living() const;

    PatchState& state_;
    double chord_;
    TrackedDeviations tracked_;
};

/// Swap edges and move corners of the triangles ``far`` until those around deviate by no more than
/// ``limit``, or for some rounds; returns those left. aim: by the estimate; both of the chord.
Triangles EvenDeviations::bring_nearer(Triangles far, int rounds, double aim, double limit) {
    const StarBounds bounds{aim * chord_, LEAST_EVENED_SHAPE};
    for (int round = 0; round < rounds && !far.empty() && !state_.stopped(); ++round) {
        tracked_.start_round();
        const int swapped = state_.swap_nearer(far, bounds);
        state_.bring_nearer(far, bounds);
        if (state_.moved.empty() && swapped == 0) break;
        tracked_.add_moved();
        far = tracked_.farther(tracked_.changed(far), limit * chord_);
    }
    return far;
}

/// Is a side of the patch, which nothing here can split, itself farther than asked?
bool EvenDeviations::has_far_side(Triangle k) const {
    const Triangulation& t = state_.t;
    for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
        if (t.adj[e] >= 0 && t.fixed[e] == 0) continue;
        const Vertex a = t.tri[e], b = t.tri[next_half_edge(e)];
        const double sag =
            0.125 * (std::abs(rise(state_.frames, a, b)) + std::abs(rise(state_.frames, b, a)));
        if (sag > FAR * chord_) return true;
    }
    return false;
}

/// Split edges of the farthest of the triangles ``far``, and bring those around nearer, by turns;
/// returns those left.
Triangles EvenDeviations::split_far(Triangles far) {
    for (int round = 0; round < EVENED_SPLIT_ROUNDS && !far.empty() && !state_.stopped(); ++round) {
        Triangles split;
        for (const Triangle k : tracked_.farthest(far, FAR * chord_))
            if (!has_far_side(k)) split.push_back(k);
        tracked_.start_round();
        if (state_.split_farthest(split) == 0) break;
        far = tracked_.farther(tracked_.changed(far), FAR * chord_);
        far = bring_nearer(std::move(far), MOVES_AFTER_SPLIT, NEAR, FAR);
    }
    return far;
}

Triangles EvenDeviations::living() const {
    Triangles found;
    for (Triangle k = 0; k < state_.t.triangles(); ++k)
        if (state_.t.region[k] != DEAD) found.push_back(k);
    return found;
}

Triangles EvenDeviations::in_rounds(bool first) {
    tracked_.look_near(ROUGHLY);
    Triangles uneven = tracked_.farther(tracked_.suspects(), EVENED * chord_);
    uneven = bring_nearer(std::move(uneven), EVENING_ROUNDS, EVEN, EVENED);
    tracked_.look_near(1.0);
    Triangles far = tracked_.farther(uneven, FAR * chord_);
    if (first && static_cast<double>(far.size()) > MANY_FAR_EVENED * state_.t.triangles())
        return far;
    far = split_far(std::move(far));
    tracked_.look_near(CLOSER);
    for (int look = 0; look < LAST_LOOKS && !state_.stopped(); ++look) {
        far = tracked_.farther(living(), FAR * chord_);
        if (far.empty()) break;
        far = split_far(std::move(far));
    }
    return far;
}

}  // namespace

Array<Triangle> even_out_deviations(PatchState& state, bool first) {
    if (!state.asked().chord) return {};
    return EvenDeviations(state).in_rounds(first);
}

}  // namespace surfmesh
