"""Where the triangles of a patch are not right: too far from the surface, folded, bent."""

import math
from dataclasses import dataclass

import numpy as np

from surfmesh.accuracy.deviation import interpolated, triangle_deviations
from surfmesh.accuracy.dihedral import SLACK, corners_beside, dihedral_angles, on_crease
from surfmesh.accuracy.folds import cosines_with_surface
from surfmesh.accuracy.samples import CENTROID
from surfmesh.kernels.optimisation.dihedral import find_dihedrals_over
from surfmesh.kernels.optimisation.optimisation import find_folded
from surfmesh.meshing.patch.state import PatchState

SUSPECT, LEAST_AT_CENTRE, LEAST_AT_CORNER = 0.85, 0.55, 0.35
"""Cosines between the normals of a triangle and of the surface: where it is looked at again,
what is folded at the centroid, and at a corner."""

ANGLE_MARGIN, ANGLE_SLACK = 0.97, 1.0 + SLACK
"""Of ``angle``: what is aimed at, at last no more than what was asked for; and what is rounding."""

NEAR_ANGLE = 0.7
"""Fraction of ``angle`` from which edges of a seam are made finer when others are bent too far:
cut anew, it would be other edges that are."""


@dataclass(frozen=True)
class Dihedrals:
    """Edges at which triangles meet at more than an angle, though the surface has no crease."""

    triangles: np.ndarray
    """(k, 2) on both sides."""
    angles: np.ndarray
    """(k,) radians between the normals."""

    def __len__(self) -> int:
        return len(self.angles)


def deviations(state: PatchState, triangles: np.ndarray, chord: float) -> np.ndarray:
    """Largest distance from the surface at samples of each of the triangles (n,)."""
    return triangle_deviations(state.surface, state.chart, *state.corners(triangles), chord)


def find_folds(state: PatchState) -> np.ndarray:
    """Triangles turned against the surface's normals at a corner or at the centroid."""
    flag = np.empty(state.triangles, np.uint8)
    find_folded(state.t, state.frames, SUSPECT, SUSPECT, flag)
    suspects = np.flatnonzero(flag)
    if not len(suspects):
        return suspects
    find_folded(state.t, state.frames, LEAST_AT_CORNER, 0.0, flag)
    corners, xy = state.corners(suspects)
    _, uv = interpolated(state.chart, corners, xy, CENTROID[0])
    at_centre = cosines_with_surface(state.surface, corners, uv) < LEAST_AT_CENTRE
    at_corner = flag[suspects] != 0
    if len(state.on_kinks):  # there a corner has the normal of one side, or of neither
        at_corner &= ~np.isin(state.t.tri.reshape(-1, 3)[suspects], state.on_kinks).any(axis=1)
    return suspects[at_centre | at_corner]


def angle_limit(angle: float, margin: float) -> float:
    """Radians, of ``angle`` in degrees."""
    return margin * math.radians(angle)


def find_dihedrals(
    state: PatchState, margin: float = ANGLE_SLACK, seams: bool = False
) -> Dihedrals:
    """Edges with an angle over ``margin`` times the one asked for; seams too, if wanted."""
    asked = state.field.sizing.angle
    if asked is None:
        return Dihedrals(np.empty((0, 2), np.int64), np.empty(0))
    limit = angle_limit(asked, margin)
    room = 3 * state.triangles // 2 + 1
    edges, angles = np.empty(room, np.int64), np.empty(room)
    count = find_dihedrals_over(state.t, state.frames.point, limit, edges, angles)
    pairs = np.stack([edges[:count], state.t.adj[edges[:count]]], axis=1)
    angles = angles[:count]
    if seams:
        across, at_seam = _across_seams(state)
        near = at_seam > NEAR_ANGLE * limit
        pairs, angles = np.concatenate([pairs, across[near]]), np.r_[angles, at_seam[near]]
    if not len(pairs):
        return Dihedrals(pairs, angles)
    corners = state.t.tri[corners_beside(pairs)]
    uv = state.parameters(corners)
    vertices = state.identified()[corners]
    kept = ~on_crease(state.surface, vertices, uv, asked, state.diagonal())
    if not (kept[count:] & (angles[count:] > limit)).any():
        kept[count:] = False  # of seams that are fine as they are
    return Dihedrals(pairs[kept] // 3, angles[kept])


def _across_seams(state: PatchState) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of half-edges (k, 2) that are identified, at poles too, and the angles (k,)."""
    live = state.is_live
    tri, adj = (a[: 3 * state.triangles] for a in (state.t.tri, state.t.adj))
    border = np.flatnonzero((adj < 0) & np.repeat(live, 3))
    number = state.identified()
    corners = number[tri].reshape(-1, 3)
    # beyond a triangle with two corners at a pole, which is an edge, lies the next one
    flat = (corners == np.roll(corners, 1, axis=1)).any(axis=1)
    beyond = adj.reshape(-1, 3)[flat & live].ravel()
    border = np.concatenate([border, beyond[beyond >= 0]])
    border = border[~flat[border // 3]]
    end = np.where(border % 3 == 2, border - 2, border + 1)
    ends = np.sort(np.stack([number[tri[border]], number[tri[end]]], axis=1), axis=1)
    real = ends[:, 0] != ends[:, 1]  # not a side that is one point
    border, ends = border[real], ends[real]
    order = np.lexsort(ends.T)
    border, ends = border[order], ends[order]
    twice = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
    pairs = np.stack([border[twice], border[twice + 1]], axis=1).reshape(-1, 2)
    triangles = state.t.tri.reshape(-1, 3)
    return pairs, dihedral_angles(state.frames.point, triangles, pairs.astype(np.int32))
