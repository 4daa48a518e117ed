#include "patch/schedule.hpp"

#include "optimisation/marked_triangles.hpp"
#include "patch/angle_reduction.hpp"
#include "patch/surface_approach.hpp"

namespace surfmesh {
namespace {

constexpr int ROUNDS = 2, FINAL_PASSES = 2;
constexpr double LEFT_OVER = 0.7;  // below this alpha, what packing or boundary have left over

// Triangles below this alpha get passes of their own, with little weight of unit edges.
constexpr double BAD_SHAPE = 0.72;

// Weight of unit edges in the passes for the worst triangles, and in those for all shapes.
constexpr double WORST_STIFFNESS = 0.3, SHAPE_STIFFNESS = 0.6;
constexpr int WORST_PASSES = 4, SHAPE_PASSES = 4;

/// Swaps, collapses and splits between passes of smoothing.
void relax(PatchState& state) {
    state.swap();
    for (int round = 1; round <= ROUNDS; ++round) {
        state.smooth();
        state.swap_for_degree();
        state.smooth();
        state.swap();
        if (round == ROUNDS) break;
        state.collapse();
        state.split();
    }
    for (int pass = 0; pass < FINAL_PASSES; ++pass)
        if (state.smooth() == 0) break;
    state.swap();
}

/// Passes for the worst triangles alone.
void improve_worst(PatchState& state) {
    state.marks.active.fill(0);
    for (int pass = 0; pass < WORST_PASSES; ++pass) {
        if (activate_bad(state.t, state.frames, state.marks, BAD_SHAPE) == 0) break;
        state.smooth(WORST_STIFFNESS);
        state.swap();
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
    relax(state);
    if (state.stopped()) return {};
    improve_worst(state);
    // it leaves all vertices moving, and so dihedral angles
    if (!state.is_anisotropic()) smooth_for_shape(state);
    reduce_dihedrals(state);
    Array<Triangle> far = approach_surface(state, first);
    if (state.stopped()) return {};
    Array<Triangle> folded = find_folds(state);
    return {std::move(far), std::move(folded), find_dihedrals(state, ANGLE_SLACK, true)};
}

void choose_diagonals(PatchState& state) { state.swap(LEFT_OVER); }

}  // namespace surfmesh
