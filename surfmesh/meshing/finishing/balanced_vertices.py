"""Vertices off their surfaces, so that these lie on both sides of the triangles, equally far.

    on the surface    .-""-.         balanced    ...-""-...       half the distance, or twice as
                    o--------o                  o----------o      long edges at the same distance

Each vertex moves by half of what its triangles lack between their farthest places on either side,
again and again; on a sphere all end half a sagitta outside. Planes stay planes, edges of two faces
move in both at once (``vertex_sites``), rims within their face too, by half the sagitta of their
chords. What would fold or meet other triangles stays where it was.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.space import meeting_triangles
from surfmesh.accuracy.samples import DENSE
from surfmesh.geometry.small_matrices import product
from surfmesh.meshing.finishing.kept_volumes import Solid, Volumes, vector_areas, volume_within
from surfmesh.meshing.finishing.second_order import put_on_curves
from surfmesh.meshing.finishing.signed_distances import PLACES, signed_distances
from surfmesh.meshing.finishing.vertex_sites import Sites, Steps
from surfmesh.result.surface_mesh import SurfaceMesh

ROUNDS, RELAXED = 16, 0.7
"""So often vertices move, by this times what they lack."""

RINGS = 8
"""Of neighbours, over which a mean is taken."""

EXACT = 1e-9
"""Relative error of an exact volume, at most."""

AIMED = 0.96
"""Of the chord: what is as good as no distance."""

SUSPECT = 0.9
"""Of the chord: from there triangles are looked at as closely as the report does."""

SMOOTH = 0.85
"""Cosine between two pieces of a rim from which their common vertex is no corner."""

TURNED = 0.8
"""Cosine between a triangle's normals before and after, below which its corners stay."""

TRIALS = 8
"""So often what does not fit is moved half as far, and then not at all."""

MOST_MEETING = 1000
"""Pairs of triangles that are looked for."""


def balanced(mesh: SurfaceMesh, chords: NDArray[np.float64], solids: list[Solid]) -> SurfaceMesh:
    """``mesh``, whose vertices lie on their surfaces, with its vertices moved.

    chords: (f,) that faces are to keep to, infinite for none. solids: whose volumes are kept. The
    same mesh where it knows no surfaces.
    """
    if not mesh.surfaces or mesh.parametrisation is None or not len(mesh.triangles):
        return mesh
    distances = signed_distances(mesh, mesh.points)
    sites = Sites.of(mesh, distances)
    steps = Steps(sites, len(mesh.points))
    known = [solid for solid in solids if _is_explained(mesh, distances, solid)]
    volumes = Volumes(mesh, sites, steps, known)
    unseen = _unseen(mesh, distances, chords)
    moves = steps.of(_lengths(mesh, distances, unseen, chords, volumes))
    moves += _along_rims(mesh, steps)
    factor = _allowed(mesh, moves)
    points = mesh.points + factor[:, None] * moves
    moved = mesh.replaced(points=volumes.pushed(points, factor == 1.0))
    if len(known) == len(solids):
        return moved
    return moved.with_warnings(
        f"the volumes of {len(solids) - len(known)} solids are not kept: the exact ones differ by "
        "more than the distance between mesh and surface explains"
    )


def _is_explained(mesh: SurfaceMesh, distances: NDArray[np.float64], solid: Solid) -> bool:
    """Does what the triangles leave out on either side explain what the solid lacks?"""
    area = np.linalg.norm(vector_areas(mesh.points, mesh.triangles), axis=1)
    explained = float((np.abs(solid.sign) * area * np.abs(distances).max(axis=1)).sum())
    missing = solid.volume - volume_within(mesh.points, mesh.triangles, solid.sign)
    return abs(missing) <= explained + EXACT * solid.volume


def _unseen(
    mesh: SurfaceMesh, distances: NDArray[np.float64], chords: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(m, 2) by how much triangles lie farther above and below their surfaces between the places
    where ``distances`` (m, q) were taken: of those that have to move for their chord."""
    found = np.zeros((len(distances), 2))
    far = np.abs(distances).max(axis=1) > SUSPECT * chords[mesh.face_ids]
    suspects = np.flatnonzero(far)
    closely = signed_distances(mesh, mesh.points, DENSE, suspects)
    for side, sign in enumerate((1.0, -1.0)):
        known = np.maximum((sign * distances[suspects]).max(axis=1), 0.0)
        found[suspects, side] = np.maximum((sign * closely).max(axis=1) - known, 0.0)
    return found


def _lengths(
    mesh: SurfaceMesh, distances: NDArray[np.float64], unseen: NDArray[np.float64],
    chords: NDArray[np.float64], volumes: Volumes,
) -> NDArray[np.float64]:  # fmt: skip
    """What sites (s,) are to move by along their normals.

    First what the triangles around lack: of solids the mean, which keeps the volume, else the
    middle of their extremes. Then, in turn, the least that brings all within an allowance, or the
    middle where that cannot be, and a push of all faces until volumes are exact.
    """
    sites, steps = volumes.sites, volumes.steps
    star = _Star(sites)
    face = np.zeros(len(sites.vertex), np.int64)
    face[sites.of_corner] = mesh.face_ids[:, None]
    within = np.where(np.isfinite(chords), AIMED * chords, 0.0)[face]
    farthest = np.where(within > 0.0, within, np.inf)
    of_solid = np.zeros(len(face), bool)
    for way in volumes.lengths:
        of_solid |= way != 0.0
    high, low = np.maximum(distances.max(axis=1), 0.0), np.minimum(distances.min(axis=1), 0.0)
    lengths = -np.where(
        of_solid,
        star.smoothed(distances[:, :3].mean(axis=1)),  # exact for quadrics
        star.smoothed(0.5 * (high + low)),
    )
    for _ in range(ROUNDS):
        rise = sites.slope * steps.reached(steps.of(lengths))[sites.of_corner]
        reached = np.hstack([distances + product(rise, PLACES.T), rise])
        top, bottom = star.extremes(reached, unseen)
        middle = 0.5 * (top + bottom)
        beyond = np.maximum(top - within, 0.0) + np.minimum(bottom + within, 0.0)
        lengths -= RELAXED * np.where(top - bottom > 2.0 * within, middle, beyond)
        if volumes.solids:
            room = within - np.maximum(top, 0.0), within + np.minimum(bottom, 0.0)
            lengths += volumes.push(mesh.points + steps.of(lengths), *room)
        lengths = np.clip(lengths, -farthest, farthest)
    return lengths


class _Star:
    """The triangles around each site."""

    def __init__(self, sites: Sites) -> None:
        corners = sites.of_corner.ravel()
        self.of_corner, self.against = sites.of_corner, sites.slope < 0.0
        self.order = np.argsort(corners, kind="stable")
        self.starts = np.searchsorted(corners[self.order], np.arange(len(sites.vertex)))
        self.count = np.bincount(corners)

    def extremes(
        self, reached: NDArray[np.float64], unseen: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The largest and the smallest (s,) of distances (m, q), and of what is unseen (m, 2)
        beyond them, along the normal of each site."""
        high = (reached.max(axis=1) + unseen[:, 0])[:, None]
        low = (reached.min(axis=1) - unseen[:, 1])[:, None]
        top = np.where(self.against, -low, high).ravel()[self.order]
        bottom = np.where(self.against, -high, low).ravel()[self.order]
        return np.maximum.reduceat(top, self.starts), np.minimum.reduceat(bottom, self.starts)

    def smoothed(self, value: NDArray[np.float64]) -> NDArray[np.float64]:
        """Means (s,) of values (m,) of triangles over some rings of neighbours."""
        sign = np.where(self.against, -1.0, 1.0)
        of_corner = sign * value[:, None]
        for turn in range(RINGS):
            total = np.bincount(self.of_corner.ravel(), of_corner.ravel(), len(self.count))
            found = total / self.count
            if turn + 1 < RINGS:
                of_corner = sign * (sign * found[self.of_corner]).mean(axis=1, keepdims=True)
        return found


def _along_rims(mesh: SurfaceMesh, steps: Steps) -> NDArray[np.float64]:
    """Steps (n, 3) by half the mean sagitta of a rim's chords, within all faces there."""
    middles = mesh.points[mesh.edges].mean(axis=1)
    chords = middles.copy()
    on = np.flatnonzero(put_on_curves(mesh, middles))
    ends, sagitta = mesh.edges[on], (middles - chords)[on]
    way = mesh.points[ends[:, 1]] - mesh.points[ends[:, 0]]
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), np.finfo(float).tiny)
    count = np.bincount(ends.ravel(), minlength=len(mesh.points))
    total, turn = np.zeros((2, len(mesh.points), 3))
    for k, sign in ((0, 1.0), (1, -1.0)):
        np.add.at(total, ends[:, k], sagitta)
        np.add.at(turn, ends[:, k], sign * way)
    smooth = (count == 2) & (np.einsum("ij,ij->i", turn, turn) < 2.0 - 2.0 * SMOOTH)
    total[~smooth] = 0.0
    return steps.within_all_faces(0.25 * total)


def _allowed(mesh: SurfaceMesh, moves: NDArray[np.float64]) -> NDArray[np.float64]:
    """Factors (n,) on the moves, lest triangles turn over or meet.

    Where a surface crosses itself by nature, other triangles meet there after any move.
    """
    factor = np.ones(len(moves))
    may_cross = mesh.facts is not None and mesh.facts.crosses_itself
    before = _unit_normals(mesh.points, mesh.triangles)
    known = None
    for trial in range(TRIALS + 1):
        points = mesh.points + factor[:, None] * moves
        cosine = np.einsum("ij,ij->i", before, _unit_normals(points, mesh.triangles))
        bad = mesh.triangles[cosine < TURNED].ravel()
        if not len(bad) and not may_cross:
            pairs = _meeting(points, mesh.triangles)
            if len(pairs) and known is None:
                known = {tuple(pair) for pair in _meeting(mesh.points, mesh.triangles).tolist()}
            new = [pair for pair in pairs.tolist() if tuple(pair) not in (known or ())]
            bad = mesh.triangles[np.array(new, np.int64).ravel()].ravel()
        if not len(bad):
            break
        factor[bad] *= 0.5 if trial < TRIALS - 1 else 0.0
    return factor


def _unit_normals(points: NDArray[np.float64], triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    a, b, c = (points[corner] for corner in triangles.T)
    normal = np.cross(b - a, c - a)
    unit: NDArray[np.float64] = normal / np.maximum(
        np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny
    )
    return unit


def _meeting(points: NDArray[np.float64], triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    """(k, 2) numbers of triangles that meet where they share nothing."""
    return meeting_triangles(points, triangles, MOST_MEETING)
