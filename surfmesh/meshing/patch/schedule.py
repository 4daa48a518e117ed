"""The order of the optimiser's passes; what each does is in kernels.optimisation.

swap -> smooth -> degrees -> smooth -> swap -> collapse, split -> ... -> smooth until still
-> the worst triangles -> shapes -> dihedral angles -> distance from the surface
"""

from dataclasses import dataclass

import numpy as np

from surfmesh.accuracy.deviation import CHORD_MARGIN
from surfmesh.kernels.optimisation.dihedral import lower_sizes
from surfmesh.kernels.optimisation.optimisation import activate_bad, estimate_deviations, shrink
from surfmesh.meshing.patch.accuracy import (
    ANGLE_MARGIN,
    ANGLE_SLACK,
    Dihedrals,
    angle_limit,
    deviations,
    find_dihedrals,
    find_folds,
)
from surfmesh.meshing.patch.state import LONGEST, PatchState

ROUNDS = 2
FINAL_PASSES = 2

LEFT_OVER = 0.7
"""Triangles below this alpha are what packing or boundary have left over."""

BAD_SHAPE = 0.72
"""Triangles below this alpha get passes of their own, with little weight of unit edges."""

WORST_STIFFNESS, SHAPE_STIFFNESS = 0.3, 0.6
"""Weight of unit edges in the passes for the worst triangles, and in those for all shapes."""

WORST_PASSES, SHAPE_PASSES = 4, 4

SUSPECT = 0.7
"""Fraction of ``chord`` from which the estimate of a triangle's deviation is not trusted."""

FEW_TRIANGLES, FLAT = 20_000, 1e-9
"""Up to so many all are measured whose estimate is no round-off, as a fraction of ``chord``: the
estimate is for triangles small beside the features."""

MANY_FAR = 0.02
"""Fraction of the triangles."""

CHORD_ROUNDS, STRETCHED_CHORD_ROUNDS, SPLIT_ROUNDS = 10, 4, 6
TOLERATED, SPLIT_MARGIN = 0.995, 0.98
"""Of ``chord``: what is let pass rather than go all the way round again. Between the samples of
a triangle the deviation may be a little larger than at them."""

ANGLE_ROUNDS, LAST_ANGLE_ROUNDS, ANGLE_SPLITS = 6, 4, 4

LEAST_ANGLE_FACTOR, LEAST_ANGLE_SCALE, LAST_ANGLE_SCALE = 0.85, 0.6, 0.3
"""Least factor on the sizes in one round, in all, and in the last rounds for a few places."""

LONGEST_AT_ANGLE = 1.25
"""Edges of stretched meshes with too large an angle are split from this length: they are not
many, and smoothing alone mends none."""


@dataclass(frozen=True)
class Changes:
    """What the optimiser did, and what it has left."""

    swaps: int
    collapses: int
    splits: int
    passes: int
    far: np.ndarray
    """Triangles still farther than ``chord`` from the surface."""
    folded: np.ndarray
    """Triangles turned far from the surface's normals."""
    dihedrals: Dihedrals
    """Edges with more than ``angle`` between their triangles."""


def optimise(state: PatchState, first: bool = True) -> Changes:
    """Optimise a patch in place; what is good already is left alone.

    first: the sizes come from no earlier round, and one with finer sizes may follow.
    """
    state.set_frames_on_kinks()
    state.swap()
    for round_number in range(ROUNDS):
        state.smooth()
        state.swap_for_degree()
        state.smooth()
        state.swap()
        if round_number + 1 < ROUNDS:
            state.collapse()
            state.split()
    for _ in range(FINAL_PASSES):
        if state.smooth() == 0:
            break
    state.swap()
    improve_worst(state)
    if not state.is_anisotropic:  # it leaves all vertices moving, and so dihedral angles
        smooth_for_shape(state)
    reduce_dihedrals(state)
    far = approach_surface(state, first)
    return Changes(
        state.swaps, state.collapses, state.splits, state.passes, far, find_folds(state),
        find_dihedrals(state, seams=True),
    )  # fmt: skip


def choose_diagonals(state: PatchState) -> None:
    """Only choose better diagonals for what the packing and the boundary left over."""
    state.swap(LEFT_OVER)


def improve_worst(state: PatchState) -> None:
    """Passes for the worst triangles alone."""
    state.active[:] = 0
    for _ in range(WORST_PASSES):
        if activate_bad(state.t, state.frames, BAD_SHAPE, state.active) == 0:
            break
        state.smooth(WORST_STIFFNESS)
        state.swap()


def smooth_for_shape(state: PatchState) -> None:
    """Last passes over all vertices, for shapes more than for unit edges."""
    state.active[:] = state.dirty[:] = 1
    for _ in range(SHAPE_PASSES):
        if state.smooth(SHAPE_STIFFNESS) == 0:
            break
    state.swap()
    state.smooth(SHAPE_STIFFNESS)


def reduce_dihedrals(state: PatchState) -> None:
    """Lower the sizes where neighbouring triangles meet at more than ``angle``."""
    asked = state.field.sizing.angle
    if asked is None:
        return
    limit = angle_limit(asked, ANGLE_MARGIN)
    longest = LONGEST_AT_ANGLE if state.is_anisotropic else LONGEST
    smoothed = ANGLE_ROUNDS + (0 if state.is_anisotropic else LAST_ANGLE_ROUNDS)
    for round_number in range(smoothed + ANGLE_SPLITS):
        last = round_number >= ANGLE_ROUNDS
        found = find_dihedrals(state, ANGLE_SLACK if last else ANGLE_MARGIN)
        if not (found.angles > angle_limit(asked, ANGLE_SLACK)).any():
            return
        if round_number >= smoothed:  # as they are smoothed others get too large an angle
            state.split_farthest(np.unique(found.triangles))
            continue
        factor = np.ones(len(state.active))
        corners = state.t.tri.reshape(-1, 3)[found.triangles].reshape(len(found), 6)
        wanted = np.maximum(limit / found.angles, LEAST_ANGLE_FACTOR)
        np.minimum.at(factor, corners, wanted[:, None])
        some = np.flatnonzero(factor < 1.0).astype(np.int32)
        smallest = LAST_ANGLE_SCALE if last else LEAST_ANGLE_SCALE
        lower_sizes(state.frames, some, factor[some], smallest, state.active)
        state.split(longest)
        for _ in range(2):
            state.smooth()
        state.swap()


def approach_surface(state: PatchState, first: bool) -> np.ndarray:
    """Bring triangles that are too far from the surface nearer; returns those left.

    An estimate from the tangent planes picks the suspects, samples on the true surface
    decide; afterwards only triangles that have changed are looked at again.
    """
    chord = state.field.sizing.chord
    if chord is None:
        return np.empty(0, np.int64)
    limit = CHORD_MARGIN * chord
    estimate = np.empty(state.triangles)
    estimate_deviations(state.t, state.frames, estimate)
    least = (SUSPECT if len(estimate) > FEW_TRIANGLES else FLAT) * chord
    suspects = np.flatnonzero(estimate > least)
    for _ in range(STRETCHED_CHORD_ROUNDS if state.is_anisotropic else CHORD_ROUNDS):
        if not len(suspects):
            return suspects
        error = deviations(state, suspects, chord)
        if shrink(state.t, state.frames, suspects, error, limit, state.active) == 0:
            break
        before = state.t.tri[: 3 * state.triangles].copy()
        changed = np.zeros(len(state.active), np.uint8)
        state.split()
        for _ in range(2):
            moved = state.smooth()
            changed[state.moved[:moved]] = 1
        state.swap()
        suspects = np.union1d(state.changed_since(before, changed), suspects[error > limit])
    error = deviations(state, suspects, chord)
    if state.is_anisotropic:
        return _split_far(state, suspects[error > SPLIT_MARGIN * chord], chord, first)
    return suspects[error > TOLERATED * chord]


def _split_far(state: PatchState, far: np.ndarray, chord: float, first: bool) -> np.ndarray:
    """Split edges of the triangles ``far`` (n,) where they are too far; returns those left.

    Smoothing and swaps do not know how far a triangle is, and in stretched meshes turn it
    more: the last few are only split. Where many are far in the first round a finer field
    needs fewer triangles than splits: then all are returned. Later it would be asked for
    again and again.
    """
    many = far if first and len(far) > MANY_FAR * state.triangles else None
    for _ in range(SPLIT_ROUNDS):
        before = state.t.tri[: 3 * state.triangles].copy()
        if not state.split_farthest(far):
            break
        changed = np.zeros(len(state.active), np.uint8)
        suspects = np.union1d(state.changed_since(before, changed), far)
        far = suspects[deviations(state, suspects, chord) > SPLIT_MARGIN * chord]
    return far if many is None else many
