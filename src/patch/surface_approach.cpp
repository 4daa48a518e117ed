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
constexpr double SUSPECT = 0.7;

// Up to so many all are measured whose estimate is no round-off, as a fraction of ``chord``: the
// estimate is for triangles small beside the features.
constexpr std::size_t FEW_TRIANGLES = 20'000;
constexpr double FLAT = 1e-9;
constexpr std::size_t BLOCK = 1 << 15;  // triangles looked through together

constexpr double MANY_FAR = 0.02;  // of the triangles
constexpr int CHORD_ROUNDS = 10, STRETCHED_CHORD_ROUNDS = 4, SPLIT_ROUNDS = 6;

// Of ``chord``: what is let pass rather than go all the way round again. Between the samples of a
// triangle the deviation may be a little larger than at them.
constexpr double TOLERATED = 0.995, SPLIT_MARGIN = 0.98;

using Triangles = Array<Triangle>;

std::span<const Triangle> all(const Triangles& triangles) {
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
    const double part = state.asked().is_width ? 0.5 * SUSPECT : SUSPECT;  // seen on one side
    const double least = (estimate.size() > FEW_TRIANGLES ? part : FLAT) * chord;
    return collect_by_blocks<Triangle>(
        estimate.size(), BLOCK, [&](std::size_t first, std::size_t last, Triangles& found) {
            for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k)
                if (estimate[k] > least) found.push_back(k);
        });
}

/// Split edges of the triangles ``far`` where they are too far; returns those left.
///
/// Smoothing and swaps do not know how far a triangle is, and in stretched meshes turn it more:
/// the last few are only split. Where many are far in the first round a finer field needs fewer
/// triangles than splits: then all are returned. Later it would be asked for again and again.
Triangles split_far(PatchState& state, Triangles far, double chord, bool first) {
    const bool many = first && static_cast<double>(far.size()) > MANY_FAR * state.t.triangles();
    const Triangles at_first = many ? far : Triangles{};
    for (int round = 0; round < SPLIT_ROUNDS && !state.stopped(); ++round) {
        Changes changes(state);
        if (state.split_farthest(all(far)) == 0) break;
        const Triangles suspects = joined(changes.triangles(), far);
        far = above(suspects, deviations(state, all(suspects), chord), SPLIT_MARGIN * chord);
    }
    return many ? at_first : far;
}

}  // namespace

Triangles approach_surface(PatchState& state, bool first) {
    if (!state.asked().chord) return {};
    const double chord = *state.asked().chord, limit = CHORD_MARGIN * chord;
    Triangles suspects = suspects_by_estimate(state, chord);
    const int rounds = state.is_anisotropic() ? STRETCHED_CHORD_ROUNDS : CHORD_ROUNDS;
    for (int round = 0; round < rounds && !state.stopped(); ++round) {
        if (suspects.empty()) return suspects;
        const Array<double> error = deviations(state, all(suspects), chord);
        if (shrink_far(state.t, state.frames, state.marks, all(suspects),
                       {error.data(), error.size()}, limit) == 0)
            break;
        state.hold_growth(false);
        Changes changes(state);
        state.split();
        for (int pass = 0; pass < 2; ++pass) {
            state.smooth();
            changes.add_moved();
        }
        state.swap();
        suspects = joined(changes.triangles(), above(suspects, error, limit));
    }
    const Array<double> error = deviations(state, all(suspects), chord);
    if (!state.is_anisotropic()) return above(suspects, error, TOLERATED * chord);
    return split_far(state, above(suspects, error, SPLIT_MARGIN * chord), chord, first);
}

}  // namespace surfmesh
