#include "patch/surface_approach.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "optimisation/deviation_estimate.hpp"
#include "optimisation/marked_triangles.hpp"
#include "patch/deviation.hpp"
#include "patch/findings.hpp"

namespace surfmesh {
namespace {

// Fraction of ``chord`` from which the estimate of a triangle's deviation is not trusted.
constexpr double SUSPECT_PART = 0.82, SUSPECT_PART_STRETCHED = 0.7;

// Up to so many all are measured whose estimate is no round-off, as a fraction of ``chord``: the
// estimate is for triangles small beside the features.
constexpr std::size_t FEW_TRIANGLES = 20'000;
constexpr double FLAT = 1e-9;
constexpr std::size_t TRIANGLES_TOGETHER = 1 << 15;  // triangles looked through together

constexpr double MANY_FAR = 0.05, MANY_FAR_STRETCHED = 0.02;  // of the triangles
constexpr int CHORD_ROUNDS = 4, STRETCHED_CHORD_ROUNDS = 4, SPLIT_ROUNDS = 6;
constexpr int MOVES = 4, INSERTION_ROUNDS = 10, SMOOTHED_ROUNDS = 6, MOVES_AFTER_INSERTION = 2;

// Of ``chord``: what is let pass rather than go all the way round again. Between the samples of a
// triangle the deviation may be a little larger than at them.
constexpr double TOLERATED = 0.985, SPLIT_MARGIN = 0.97;

// Of ``chord``: what moves aim at by the estimate, which knows sides and centroid: between them a
// quadric is up to 4.2 % farther. And from where the farthest have vertices inserted before others.
constexpr double ESTIMATE_MARGIN = 0.93, CLEARLY_FAR = 1.05;

// Where edges are not split, smaller sizes only steer: with smaller ones than that they would no
// longer be what edges are like.
constexpr double STEERED_SCALE = 0.8;

constexpr double LEAST_SHAPE = 0.72;  // alpha that moves keep to or restore

using Triangles = Array<Triangle>;

std::span<const Triangle> every(const Triangles& triangles) {
    return {triangles.data(), triangles.size()};
}

/// Those of the triangles with more than ``limit``.
Triangles above(const Triangles& triangles, const Array<double>& deviation, double limit) {
    Triangles found;
    for (std::size_t k = 0; k < triangles.size(); ++k)
        if (deviation[k] > limit) found.push_back(triangles[k]);
    return found;
}

Triangles joined(const Triangles& a, const Triangles& b) {
    Triangles both(a.size() + b.size());
    Triangle* end = std::set_union(a.begin(), a.end(), b.begin(), b.end(), both.begin());
    both.resize(static_cast<std::size_t>(end - both.begin()));
    return both;
}

/// Vertices that have moved, and corners of triangles that are not what they were.
class Changes {
  public:
    explicit Changes(const PatchState& state) : state_(state), before_(state.t.tri) {}

    void add_moved() {
        changed_.resize(state_.t.xy.size(), 0);
        for (const Vertex v : state_.moved) changed_[v] = 1;
    }
    /// The triangles with a vertex that has moved, or with one of a triangle that has changed.
    Triangles triangles() {
        const Array<Vertex>& now = state_.t.tri;
        changed_.resize(state_.t.xy.size(), 0);
        for (std::size_t e = 0; e < now.size(); ++e)
            if (e >= before_.size() || now[e] != before_[e]) changed_[now[e]] = 1;
        return triangles_at(state_.t, changed_);
    }

  private:
    const PatchState& state_;
    Array<Vertex> before_;
    Array<std::uint8_t> changed_;
};

Triangles suspects_by_estimate(const PatchState& state, double chord) {
    const Array<double> estimate = estimate_deviations(state.t, state.frames);
    const double one_sided = state.is_anisotropic() ? SUSPECT_PART_STRETCHED : SUSPECT_PART;
    const double part = state.asked().is_width ? 0.5 * one_sided : one_sided;
    const double least = (estimate.size() > FEW_TRIANGLES ? part : FLAT) * chord;
    return collect_by_blocks<Triangle>(estimate.size(), TRIANGLES_TOGETHER,
                                       [&](std::size_t first, std::size_t last, Triangles& found) {
                                           for (auto k = static_cast<Triangle>(first);
                                                k < static_cast<Triangle>(last); ++k)
                                               if (estimate[k] > least) found.push_back(k);
                                       });
}

bool is_many(const PatchState& state, const Triangles& far) {
    const double part = state.is_anisotropic() ? MANY_FAR_STRETCHED : MANY_FAR;
    return static_cast<double>(far.size()) > part * state.t.triangles();
}

/// Lower the sizes at triangles that lie too far and let vertices move there, by turns; returns
/// those left. splits: edges that are too long then are split.
Triangles shrink_in_rounds(PatchState& state, Triangles suspects, double chord, int rounds,
                           bool splits) {
    const double limit = CHORD_MARGIN * chord;
    for (int round = 0; round < rounds && !suspects.empty() && !state.stopped(); ++round) {
        const Array<double> error = deviations(state, every(suspects), chord);
        if (shrink_far(state.t, state.frames, state.marks, every(suspects),
                       {error.data(), error.size()}, limit,
                       splits ? SMALLEST_SCALE : STEERED_SCALE) == 0)
            break;
        state.hold_growth(false);
        Changes changes(state);
        if (splits) state.split();
        for (int pass = 0; pass < 2; ++pass) {
            state.smooth();
            changes.add_moved();
        }
        state.swap();
        suspects = joined(changes.triangles(), above(suspects, error, limit));
    }
    return above(suspects, deviations(state, every(suspects), chord), SPLIT_MARGIN * chord);
}

/// Move corners of the triangles ``far`` until those around are near; returns those left.
Triangles move_far(PatchState& state, Triangles far, double chord, int rounds) {
    for (int round = 0; round < rounds && !far.empty() && !state.stopped(); ++round) {
        Changes changes(state);
        state.bring_nearer(every(far), {ESTIMATE_MARGIN * chord, LEAST_SHAPE});
        if (state.moved.empty()) break;
        changes.add_moved();
        const Triangles suspects = joined(changes.triangles(), far);
        far = above(suspects, deviations(state, every(suspects), chord), SPLIT_MARGIN * chord);
    }
    return far;
}

/// The farthest of the triangles: those in the upper half of what they exceed the limit by.
Triangles farthest_of(PatchState& state, const Triangles& far, double chord) {
    const Array<double> error = deviations(state, every(far), chord);
    double most = 0.0;
    for (const double e : error) most = std::max(most, e);
    const double limit = SPLIT_MARGIN * chord;
    return above(far, error, most > CLEARLY_FAR * chord ? 0.5 * (limit + most) : limit);
}

/// Insert vertices at the farthest of the triangles ``far``, and smooth around them; returns those
/// left. What is inserted at one brings others near: so by turns, the farthest first. Where the
/// surface turns over, smoothing brings others far again: the last rounds do without.
Triangles insert_far(PatchState& state, Triangles far, double chord) {
    for (int round = 0; round < INSERTION_ROUNDS && !far.empty() && !state.stopped(); ++round) {
        Changes changes(state);
        state.marks.active.fill(0);
        if (state.split_farthest(every(farthest_of(state, far, chord))) == 0) break;
        for (int pass = 0; pass < 2 && round < SMOOTHED_ROUNDS; ++pass) {
            state.swap();
            state.smooth();
            changes.add_moved();
        }
        state.swap();
        const Triangles suspects = joined(changes.triangles(), far);
        far = above(suspects, deviations(state, every(suspects), chord), SPLIT_MARGIN * chord);
        far = move_far(state, std::move(far), chord, MOVES_AFTER_INSERTION);
    }
    return far;
}

/// Split edges of the triangles ``far`` where they are too far; returns those left.
///
/// In stretched meshes smoothing and swaps turn triangles and bring others farther: the last few
/// are only split. Where many are far in the first round a finer field needs fewer triangles than
/// splits: then all are returned. Later it would be asked for again and again.
Triangles split_far(PatchState& state, Triangles far, double chord, bool first) {
    const bool many = first && is_many(state, far);
    const Triangles at_first = many ? far : Triangles{};
    for (int round = 0; round < SPLIT_ROUNDS && !state.stopped(); ++round) {
        Changes changes(state);
        if (state.split_farthest(every(far)) == 0) break;
        const Triangles suspects = joined(changes.triangles(), far);
        far = above(suspects, deviations(state, every(suspects), chord), SPLIT_MARGIN * chord);
    }
    return many ? at_first : far;
}

}  // namespace

Triangles approach_surface(PatchState& state, bool first) {
    if (!state.asked().chord) return {};
    const double chord = *state.asked().chord;
    const bool stretched = state.is_anisotropic();
    Triangles far = shrink_in_rounds(state, suspects_by_estimate(state, chord), chord,
                                     stretched ? STRETCHED_CHORD_ROUNDS : CHORD_ROUNDS, stretched);
    if (stretched) return split_far(state, std::move(far), chord, first);
    far = move_far(state, std::move(far), chord, MOVES);
    if (first && is_many(state, far)) return far;
    state.allow_splits();
    far = insert_far(state, std::move(far), chord);
    return above(far, deviations(state, every(far), chord), TOLERATED * chord);
}

}  // namespace surfmesh
