"""Upper bounds of the size, for another round, where the optimiser could not mend a patch."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from surfmesh.accuracy.deviation import CHORD_MARGIN
from surfmesh.accuracy.folds import sharp_radius
from surfmesh.geometry.differential.sharp_bends import bends_sharply
from surfmesh.meshing.patch.accuracy import ANGLE_MARGIN, Dihedrals, angle_limit, deviations
from surfmesh.meshing.patch.schedule import Changes
from surfmesh.meshing.patch.state import PatchState
from surfmesh.sizing.options.defaults import FINEST_BY_ANGLE, LEAST_OF_CHORD
from surfmesh.sizing.rules.size_limits import SizeLimits

FOLD_FACTOR = 0.6
"""On the sizes where triangles are folded."""

CHORD_FACTORS, ANGLE_FACTORS = (0.5, 0.8), (0.5, 0.85)
"""Least and largest factor on the sizes where triangles are too far, or their angles too large."""

LOWER = 0.97
"""What asks for more than this fraction of the present size is no request."""


class SizeRequests(NamedTuple):
    """What a patch asks for, by what is not right there; None for nothing."""

    chord: SizeLimits | None = None
    folds: SizeLimits | None = None
    angle: SizeLimits | None = None


def joined(*requests: SizeLimits | None) -> SizeLimits | None:
    """All of them, in their order; None where there is none."""
    found: SizeLimits | None = None
    for request in requests:
        if request is not None and len(request.sizes):
            found = request if found is None else found.joined_with(request)
    return found


def size_requests(
    state: PatchState, changes: Changes, off_surface: np.ndarray | None = None
) -> SizeRequests:
    """What would mend what ``changes`` has left.

    off_surface: (vertices,) marks of those that lie off the surface themselves: for the
    triangles at them smaller sizes are no help.
    """
    far, folded = changes.far, changes.folded
    if off_surface is not None:
        corners = state.t.tri.reshape(-1, 3)
        far, folded = (some[~off_surface[corners[some]].any(axis=1)] for some in (far, folded))
    return SizeRequests(
        limits_for_chord(state, far) if len(far) else None,
        limits_for_folds(state, folded) if len(folded) else None,
        limits_for_angle(state, changes.dihedrals) if len(changes.dihedrals) else None,
    )


def limits_for_chord(state: PatchState, triangles: np.ndarray) -> SizeLimits | None:
    """Limits under which ``triangles`` (n,) would come to lie within ``chord``."""
    chord = state.field.sizing.chord
    if chord is None:
        return None
    error = deviations(state, triangles, chord)
    factor = np.clip(np.sqrt(CHORD_MARGIN * chord / error), *CHORD_FACTORS)
    return _limits_at(state, triangles, factor, 2.0 * chord)


def limits_for_folds(state: PatchState, triangles: np.ndarray) -> SizeLimits:
    """Limits under which the folded ``triangles`` (n,) may unfold.

    None where the surface itself turns over, or bends sharply: no size is small enough.
    """
    chord = state.field.sizing.chord
    radius = sharp_radius(chord, state.diagonal())
    uv = state.parameters(state.t.tri.reshape(-1, 3)[triangles])
    smooth = ~bends_sharply(state.surface, uv, radius)
    return _limits_at(state, triangles[smooth], FOLD_FACTOR, LEAST_OF_CHORD * (chord or 0.0))


def limits_for_angle(state: PatchState, dihedrals: Dihedrals) -> SizeLimits | None:
    """Limits under which triangles would meet at no more than ``angle``."""
    angle = state.field.sizing.angle
    if angle is None:
        return None
    factor = np.clip(angle_limit(angle, ANGLE_MARGIN) / dihedrals.angles, *ANGLE_FACTORS)
    least = FINEST_BY_ANGLE * state.diagonal()
    return _limits_at(state, dihedrals.triangles.ravel(), np.repeat(factor, 2), least)


def _limits_at(
    state: PatchState, triangles: np.ndarray, factor: np.ndarray | float, least: float
) -> SizeLimits:
    """The field's sizes at the corners of ``triangles`` (n,) times ``factor``.

    Only where that is smaller than now: not below ``least``, which no mesh needs, nor
    below ``min_size``.
    """
    sizing, frames = state.field.sizing, state.frames
    least = max(least, sizing.min_size or 0.0)
    corners = state.t.tri.reshape(-1, 3)[triangles]
    chosen, place = np.unique(corners, return_inverse=True)
    smallest = np.ones(len(chosen))  # factor of all triangles at a corner
    wanted = np.broadcast_to(np.asarray(factor).reshape(-1, 1), corners.shape)
    np.minimum.at(smallest, place.ravel(), wanted.ravel())
    now = frames.size[chosen] / frames.scale[chosen]
    sizes = np.maximum(smallest * now, least)
    finer = sizes < LOWER * now
    chosen, now, sizes = chosen[finer], now[finer], sizes[finer]
    limits = SizeLimits(frames.point[chosen], sizes, sizing.gradient)
    if not state.is_anisotropic:
        return limits
    shrunk = frames.scale[chosen] * now / sizes
    return replace(
        limits,
        uv=state.parameters(chosen),
        metric_root_3d=frames.metric_root_3d[chosen] * shrunk[:, None],
    )
