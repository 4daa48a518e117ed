#include "patch/schedule.hpp"

#include <algorithm>
#include <atomic>
#include <span>

#include "optimisation/marked_triangles.hpp"
#include "patch/angle_reduction.hpp"
#include "patch/stretched_even_use.hpp"
#include "patch/surface_approach.hpp"

namespace surfmesh {
namespace {

// Up to this fraction of the triangles only what collapses and splits change is smoothed anew.
constexpr double MANY_CHANGES = 0.01;

constexpr int STRETCHED_PASSES = 2;

// Triangles below this alpha get passes of their own, with little weight of unit edges.
constexpr double BAD_SHAPE = 0.72;

// In the end this part of the triangles is raised to the alpha of the others, within limits: below
// the first is always bad, above the second always good. Their neighbours lose what they gain.
constexpr double WORST_PART = 0.0005, RAISED[] = {0.65, 0.86};
constexpr int RAISING_PASSES = 3, BORDER_PASSES = 4;
constexpr std::size_t SHAPES_TOGETHER = 1 << 15;  // looked at together

// Triangles below this alpha lose a corner where what it leaves can be filled with better ones.
constexpr double FILLED_ANEW = 0.82;

constexpr double LEFT_OVER = 0.7;  // below this alpha, what packing or boundary have left over

constexpr double WORST_STIFFNESS = 0.3;  // of unit edges in the passes for the worst triangles

// Vertices that have moved by less, in unit lengths, keep their frames until all is settled: they
// are off the surface by about half its curvature times the square.
constexpr double KEPT_DRIFT = 0.15, KEPT_DRIFT_STRETCHED = 0.1;

// Stretched meshes still move when they are settled. What is then lowered or split wakes those
// around it; with a smaller distance most of the mesh would be awake after a few rounds.
constexpr double STILL_SETTLED = 0.04;

// Stretched sizes are held to growth again where this part of the vertices had to be lowered:
// few surfaces. With less others get more triangles and hold it no better.
constexpr double MANY_LOWERED = 0.3;
constexpr int GROWTH_ROUNDS = 4;

constexpr int WORST_PASSES = 4, SHAPE_PASSES = 3;

void smooth_and_swap(PatchState& state) {
    state.smooth();
    state.swap_for_degree();
    state.smooth();
    state.swap();
}

/// Swaps, collapses and splits between passes of smoothing.
void relax(PatchState& state) {
    state.swap();
    smooth_and_swap(state);
    const int before = state.collapses + state.splits;
    state.collapse();
    state.split();
    const int changes = state.collapses + state.splits - before;
    if (state.is_anisotropic()) {  // its moves are larger, and no passes for shape follow
        smooth_and_swap(state);
        for (int pass = 0; pass < STRETCHED_PASSES; ++pass)
            if (state.smooth() == 0) break;
        state.swap();
        return;
    }
    if (changes == 0) return;
    if (changes < MANY_CHANGES * state.t.triangles()) state.marks.active = state.marks.dirty;
    smooth_and_swap(state);
}

/// Between the ways that the size field is graded along, the metric may turn faster than sizes grow.
void hold_growth(PatchState& state) {
    if (!state.is_anisotropic()) return;
    for (int round = 0; round < GROWTH_ROUNDS; ++round) {
        const int lowered = state.hold_growth(true);
        if (lowered == 0) return;
        state.split();
        state.smooth();
        state.smooth();
        state.swap();
        if (lowered < MANY_LOWERED * static_cast<double>(state.t.xy.size())) return;
    }
}

/// Passes for the worst triangles alone.
void improve_worst(PatchState& state) {
    state.marks.active.fill(0);
    for (int pass = 0; pass < WORST_PASSES; ++pass) {
        const std::span<const double> shape{state.shape.data(), state.shape.size()};
        if (activate_bad(state.t, state.frames, shape, state.marks, BAD_SHAPE) == 0) break;
        state.smooth(WORST_STIFFNESS);
        state.swap();
    }
}

/// Alpha of the triangle that has WORST_PART of all before it, as swaps have last seen them, as far
/// as it is below ``most``.
double shape_of_worst_part(const PatchState& state, double most) {
    const Triangulation& t = state.t;
    std::atomic<std::size_t> living = 0;
    Array<double> below = collect_by_blocks<double>(
        t.region.size(), SHAPES_TOGETHER,
        [&](std::size_t first, std::size_t last, Array<double>& own) {
            std::size_t count = 0;
            for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k) {
                if (t.region[k] == DEAD) continue;
                ++count;
                if (state.shape[k] < most) own.push_back(state.shape[k]);
            }
            living += count;
        });
    const auto before =
        static_cast<std::ptrdiff_t>(WORST_PART * static_cast<double>(living.load()));
    if (before >= static_cast<std::ptrdiff_t>(below.size())) return most;
    double* const nth = below.begin() + before;
    std::nth_element(below.begin(), nth, below.end());
    return *nth;
}

/// Bring degrees along the border to what they should be at triangles below the alpha ``least``.
void mend_border(PatchState& state, double least) {
    const int swapped = state.swap_at_border(least);
    if (state.remove_at_border(least) + swapped == 0) return;
    for (int pass = 0; pass < BORDER_PASSES; ++pass)
        if (state.smooth(SHAPE_STIFFNESS) == 0) break;
    state.swap(least);
}

/// Raise the smallest alpha of the few worst triangles, whatever their edges.
void raise_worst(PatchState& state) {
    if (state.stopped() || state.shape.size() < state.t.region.size()) return;
    const double least = std::max(shape_of_worst_part(state, RAISED[1]), RAISED[0]);
    mend_border(state, least);
    for (int pass = 0; pass < RAISING_PASSES; ++pass) {
        state.raise_worst(least);
        if (state.moved.empty()) break;
        state.swap(least);
    }
}

/// Last passes over all vertices, for shapes more than for unit edges.
void smooth_for_shape(PatchState& state) {
    state.marks.active.fill(1);
    state.marks.dirty.fill(1);
    for (int pass = 0; pass < SHAPE_PASSES; ++pass)
        if (state.smooth(SHAPE_STIFFNESS) == 0) break;
    state.swap();
    state.smooth(SHAPE_STIFFNESS);
}

}  // namespace

Unmended optimise(PatchState& state, bool first) {
    state.set_frames_on_kinks();
    state.kept_drift = state.is_anisotropic() ? KEPT_DRIFT_STRETCHED : KEPT_DRIFT;
    relax(state);
    if (state.stopped()) return {};
    if (!state.is_anisotropic()) state.remove_worst(FILLED_ANEW);
    improve_worst(state);
    if (!state.is_anisotropic()) state.insert_at_worst(BAD_SHAPE);
    // it leaves all vertices moving, and so dihedral angles
    if (!state.is_anisotropic()) {
        smooth_for_shape(state);
        raise_worst(state);
    }
    state.settle();
    state.kept_drift = 0.0;
    if (state.is_anisotropic()) state.still = STILL_SETTLED;
    hold_growth(state);
    reduce_dihedrals(state);
    Array<Triangle> far = state.asked().fewest && state.is_anisotropic()
                              ? even_out_deviations(state, first)
                              : approach_surface(state, first);
    if (state.stopped()) return {};
    Array<Triangle> folded = find_folds(state);
    return {std::move(far), std::move(folded), find_dihedrals(state, ANGLE_SLACK, true)};
}

void choose_diagonals(PatchState& state) { state.swap(LEFT_OVER); }

}  // namespace surfmesh
