#include "patch/surface_approach.hpp"

#include <algorithm>
#include <utility>

#include "optimisation/marked_triangles.hpp"
#include "optimisation/size_reduction.hpp"
#include "patch/deviation.hpp"
#include "patch/even_use.hpp"
#include "patch/tracked_deviations.hpp"

namespace surfmesh {
namespace {

constexpr double MANY_FAR = 0.05, MANY_FAR_STRETCHED = 0.02;  // of the triangles
constexpr int CHORD_ROUNDS = 4, STRETCHED_CHORD_ROUNDS = 4, SPLIT_ROUNDS = 6;
constexpr int MOVES = 4, STRETCHED_MOVES = 2, INSERTION_ROUNDS = 10, SMOOTHED_ROUNDS = 6,
              MOVES_AFTER_INSERTION = 2;

// Of ``chord``: what is let pass rather than go all the way round again. Between the samples of a
// triangle the deviation may be a little larger than at them.
constexpr double TOLERATED = 0.985, SPLIT_MARGIN = 0.97;

// Of ``chord``: what moves aim at by the estimate, which knows sides and centroid: between them a
// quadric is up to 4.2 % farther.
constexpr double ESTIMATE_MARGIN = 0.93;

// Where edges are not split, smaller sizes only steer: with smaller ones than that they would no
// longer be what edges are like.
constexpr double STEERED_SCALE = 0.8;

constexpr double LEAST_SHAPE = 0.94;  // alpha that moves keep to or restore, where they can

// In the end corners of triangles below the first alpha move once more, and those around lose no
// more than they must, down to the second.
constexpr double BAD_AT_LAST = 0.9, KEPT_AT_LAST = 0.98;

using Triangles = Array<Triangle>;

bool is_many(const PatchState& state, const Triangles& far) {
    const double part = state.is_anisotropic() ? MANY_FAR_STRETCHED : MANY_FAR;
    return static_cast<double>(far.size()) > part * state.t.triangles();
}

/// Triangles that are too far, and their rounds.
class SurfaceApproach {
  public:
    explicit SurfaceApproach(PatchState& state)
        : state_(state), chord_(*state.asked().chord), tracked_(state, chord_) {}

    Triangles in_rounds(bool first);

  private:
    Triangles shrink_in_rounds(int rounds, bool splits);
    Triangles move_far(Triangles far, int rounds);
    void move_held();
    Triangles raise_bad(Triangles far);
    /// Where rims meet a lattice, far triangles are of bad shape too.
    [[nodiscard]] double stiffness() const {
        return state_.on_lattice() ? SHAPE_STIFFNESS : STIFFNESS;
    }
    Triangles insert_far(Triangles far);
    Triangles split_far(Triangles far, bool first);
    Triangles left_of(const Triangles& suspects, double margin = SPLIT_MARGIN) {
        return tracked_.farther(suspects, margin * chord_);
    }

    PatchState& state_;
    double chord_;
    TrackedDeviations tracked_;
};

/// Lower the sizes at triangles that lie too far and let vertices move there, by turns; returns
/// those left. splits: edges that are too long then are split.
Triangles SurfaceApproach::shrink_in_rounds(int rounds, bool splits) {
    const double limit = CHORD_MARGIN * chord_;
    Triangles suspects = tracked_.suspects();
    state_.marks.active.fill(0);  // the rest is as smooth as it will be
    for (int round = 0; round < rounds && !suspects.empty() && !state_.stopped(); ++round) {
        const Array<double> error = tracked_.measure(suspects);
        if (shrink_far(state_.t, state_.frames, state_.marks, suspects, error, limit,
                       splits ? SMALLEST_SCALE : STEERED_SCALE) == 0)
            break;
        state_.hold_growth(false);
        tracked_.start_round();
        if (splits) state_.split();
        for (int pass = 0; pass < 2; ++pass) {
            state_.smooth(splits ? STIFFNESS : stiffness());
            tracked_.add_moved();
        }
        state_.swap();
        suspects = tracked_.changed(farther_than(limit, suspects, error));
    }
    return left_of(suspects);
}

/// Move corners of the triangles ``far`` until those around are near; returns those left.
Triangles SurfaceApproach::move_far(Triangles far, int rounds) {
    for (int round = 0; round < rounds && !far.empty() && !state_.stopped(); ++round) {
        tracked_.start_round();
        state_.bring_nearer(far, {ESTIMATE_MARGIN * chord_, LEAST_SHAPE});
        if (state_.moved.empty()) break;
        tracked_.add_moved();
        far = left_of(tracked_.changed(far));
    }
    return far;
}

/// Move corners of the triangles that are far because of ``min_size``: no more can be done for them,
/// and nobody has to know how near they come.
void SurfaceApproach::move_held() {
    const Triangles held = tracked_.held();
    for (int round = 0; round < MOVES && !held.empty() && !state_.stopped(); ++round) {
        state_.bring_nearer(held, {ESTIMATE_MARGIN * chord_, LEAST_SHAPE});
        if (state_.moved.empty()) return;
    }
}

/// Move corners of triangles of bad shape, be they ``far`` or not; returns those left that are far.
Triangles SurfaceApproach::raise_bad(Triangles far) {
    if (state_.stopped()) return far;
    const Triangles bad = triangles_below(state_.t, state_.frames, BAD_AT_LAST);
    if (bad.empty()) return far;
    tracked_.start_round();
    state_.bring_nearer(bad, {ESTIMATE_MARGIN * chord_, KEPT_AT_LAST});
    if (state_.moved.empty()) return far;
    tracked_.add_moved();
    return move_far(left_of(tracked_.changed(far)), MOVES_AFTER_INSERTION);
}

/// Insert vertices at the farthest of the triangles ``far``, and smooth around them; returns those
/// left. What is inserted at one brings others near: so by turns, the farthest first. Where the
/// surface turns over, smoothing brings others far again: the last rounds do without.
Triangles SurfaceApproach::insert_far(Triangles far) {
    for (int round = 0; round < INSERTION_ROUNDS && !far.empty() && !state_.stopped(); ++round) {
        tracked_.start_round();
        state_.marks.active.fill(0);
        if (state_.split_farthest(tracked_.farthest(far, SPLIT_MARGIN * chord_)) == 0) break;
        for (int pass = 0; pass < 2 && round < SMOOTHED_ROUNDS; ++pass) {
            state_.swap();
            if (pass == 0 && state_.on_lattice()) state_.swap_for_degree();
            state_.smooth(stiffness());
            tracked_.add_moved();
        }
        state_.swap();
        far = left_of(tracked_.changed(far));
        far = move_far(std::move(far), MOVES_AFTER_INSERTION);
    }
    return far;
}

/// Split edges of the triangles ``far`` where they are too far; returns those left.
///
/// In stretched meshes smoothing and swaps turn triangles and bring others farther: the last few
/// that moves leave are only split. Where many are far in the first round a finer field needs fewer
/// triangles than splits: then all are returned. Later it would be asked for again and again.
Triangles SurfaceApproach::split_far(Triangles far, bool first) {
    const bool many = first && is_many(state_, far);
    const Triangles at_first = many ? far : Triangles{};
    for (int round = 0; round < SPLIT_ROUNDS && !state_.stopped(); ++round) {
        tracked_.start_round();
        if (state_.split_farthest(far) == 0) break;
        far = left_of(tracked_.changed(far));
    }
    return many ? at_first : far;
}

Triangles SurfaceApproach::in_rounds(bool first) {
    const bool stretched = state_.is_anisotropic();
    Triangles far = shrink_in_rounds(stretched ? STRETCHED_CHORD_ROUNDS : CHORD_ROUNDS, stretched);
    if (stretched) {
        if (!(first && is_many(state_, far))) far = move_far(std::move(far), STRETCHED_MOVES);
        return split_far(std::move(far), first);
    }
    far = move_far(std::move(far), MOVES);
    move_held();
    if (first && is_many(state_, far)) return far;
    state_.allow_splits();
    far = insert_far(std::move(far));
    if (state_.on_lattice()) far = raise_bad(std::move(far));
    return left_of(far, TOLERATED);
}

}  // namespace

Triangles approach_surface(PatchState& state, bool first) {
    if (!state.asked().chord) return {};
    if (uses_evenly(state.asked(), state.background())) return approach_evenly(state, first);
    return SurfaceApproach(state).in_rounds(first);
}

}  // namespace surfmesh
