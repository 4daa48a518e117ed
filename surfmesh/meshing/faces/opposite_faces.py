"""Two sides of a wall thinner than the chord: meshed once, so that they do not cross.

a  o-----o-----o-----o       every boundary node of a faces one of b, by the mates of the
   :     :     :     :       edges: b takes over the triangles of a, with the inner nodes
b  o-----o-----o-----o       at their feet. Meshed one by one, both bend within the chord
                             in their own places, and meet.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from surfmesh._core.space import PointTree
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.meshing.faces.face_data import FaceJob, FaceMesh
from surfmesh.meshing.faces.strip_triangulation import LEAST_COSINE, face_cosines

STEPS = 12
"""Of Gauss-Newton, to the foot of an inner node."""

APART = 2.0
"""Feet may lie so many narrow widths away."""


def opposite_pairs(model: CadModel, samples: EdgeSamples) -> list[tuple[int, int, float]]:
    """(face, face, width): pairs whose edges are mates, with their narrow width."""
    if not samples.mates:
        return []
    mates: dict[int, set[int]] = {}
    for edge, mate in zip(samples.mates.edge.tolist(), samples.mates.mate.tolist()):
        mates.setdefault(edge, set()).add(mate)
    found: dict[int, tuple[int, float]] = {}
    edges = [set(own.tolist()) for own in np.split(samples.face_edges, samples.first_of_face[1:-1])]
    seams = [{c.edge for c in face.coedges if c.seam} for face in model.faces]
    for first in range(len(model.faces)):
        rim = edges[first] - seams[first]
        if first in samples.narrow or not rim or not all(edge in mates for edge in rim):
            continue
        facing = {mate for edge in rim for mate in mates[edge]}
        users = {face for mate in facing for face in model.faces_of_edge(mate)}
        for second in sorted(users - set(samples.narrow)):
            own = edges[second] - seams[second]
            width = float(min(samples.narrow_width[[first, second]]))
            if (
                second > first and first not in found and not own & rim
                and len(model.faces[first].loops) == len(model.faces[second].loops)
                and all(mates.get(edge, set()) & own for edge in rim)
                and all(mates.get(edge, set()) & rim for edge in own)
            ):  # fmt: skip
                found[first] = second, width
    taken: set[int] = set()
    pairs = []
    for first, (second, width) in found.items():
        if first not in taken and second not in taken:
            taken |= {first, second}
            pairs.append((first, second, width))
    return pairs


def copied(found: FaceMesh, job: FaceJob, other: FaceJob, width: float) -> FaceMesh | None:
    """The mesh of another face with the triangles of this one; None where they do not fit.

    job, other: of the face that was meshed, and of the one opposite.
    """
    pieces = [piece for each in (job, other) for loop in each.loops for piece in loop]
    if found.failure or not len(found.triangles) or any(piece.degenerate for piece in pieces):
        return None
    facing = _facing(job, other, width)
    if facing is None:
        return None
    slots, uv_of, turned = facing
    if not all(int(slot) in slots for slot in found.slots[found.slots >= 0]):
        return None
    used, images = np.unique(found.uv_triangles, return_inverse=True)  # of removed vertices none
    images, known = images.reshape(-1, 3), found.uv_points[used]
    row_of = np.empty(len(used), np.int64)  # the point of each image
    row_of[images] = found.triangles
    uv = np.full(known.shape, np.nan)
    for k in np.flatnonzero(found.slots[row_of] >= 0).tolist():
        place = uv_of.get(tuple(known[k].tolist()))
        if place is None:
            return None
        uv[k] = place
    inner = np.isnan(uv[:, 0])
    surface = other.surface
    points = found.points.copy()
    if inner.any():
        uv[inner] = _between(images, uv, inner)
        if not np.isfinite(uv).all():
            return None
        feet, away, places = closest_point(surface, found.points[row_of[inner]], uv[inner], STEPS)
        if not away.max() <= APART * width:
            return None
        uv[inner], points[row_of[inner]] = feet, places
    own = np.array([slots.get(int(slot), -1) for slot in found.slots])
    at = np.concatenate([piece.points for loop in other.loops for piece in loop])
    points[own >= 0] = at[own[own >= 0]]
    order = [0, 2, 1] if turned else [0, 1, 2]
    triangles, images = found.triangles[:, order], images[:, order].astype(np.int32)
    cosine = face_cosines(surface, points[triangles], uv[images])
    if not (cosine > LEAST_COSINE).all():
        return None
    return replace(
        found, points=points, slots=own, triangles=triangles, uv_points=uv, uv_triangles=images,
        inverse_sizes=None, refinement=None,
    )  # fmt: skip


def _rings(job: FaceJob) -> list[tuple[np.ndarray, ...]]:
    """Of each loop numbers (n,), slots (n,), points (n, 3) and uv (n, 2), each node once."""
    rings, slot = [], 0
    for loop in job.loops:
        rows = []
        for piece in loop:
            count = len(piece.numbers)
            rows.append((piece.numbers[:-1], slot + np.arange(count - 1), piece.points[:-1],
                         piece.uv[:-1]))  # fmt: skip
            slot += count
        rings.append(tuple(map(np.concatenate, zip(*rows))))
    return rings


def _facing(job: FaceJob, other: FaceJob, width: float) -> tuple[dict, dict, bool] | None:
    """Which slot faces which, uv of the other by uv of the first, and whether loops run back."""
    rings, others = _rings(job), _rings(other)
    numbers, points = (np.concatenate([ring[k] for ring in others]) for k in (0, 2))
    mine = np.concatenate([ring[0] for ring in rings])
    away, near = PointTree(points).nearest(np.concatenate([ring[2] for ring in rings]), 1)
    if len(mine) != len(numbers) or not away.max() <= math.sqrt(2.0) * width:
        return None
    mate = dict(zip(mine.tolist(), numbers[near[:, 0]].tolist()))
    if len(set(mate.values())) < len(mate):
        return None
    slots: dict[int, int] = {}
    uv_of: dict[tuple, np.ndarray] = {}
    ways = set()
    for ring in rings:
        wanted = [mate[number] for number in ring[0].tolist()]
        for their in others:
            found = _rotation(wanted, their[0].tolist())
            if found is not None:
                rows, back = found
                ways.add(back)
                slots.update(zip(ring[1].tolist(), their[1][rows].tolist()))
                uv_of.update(zip(map(tuple, ring[3].tolist()), their[3][rows]))
    if len(slots) < len(mine) or len(ways) != 1:
        return None
    return slots, uv_of, ways.pop()


def _rotation(wanted: list[int], ring: list[int]) -> tuple[np.ndarray, bool] | None:
    """Rows of a ring that give the wanted numbers, and whether they run back."""
    count = len(wanted)
    if count != len(ring):
        return None
    for back in (True, False):
        for start in (k for k, number in enumerate(ring) if number == wanted[0]):
            rows = (start + (-1 if back else 1) * np.arange(count)) % count
            if [ring[row] for row in rows.tolist()] == wanted:
                return rows, back
    return None


def _between(triangles: np.ndarray, uv: np.ndarray, inner: np.ndarray) -> np.ndarray:
    """Images (k, 2) of inner nodes that are the means of their neighbours': first guesses."""
    from scipy.sparse import coo_matrix, diags
    from scipy.sparse.linalg import spsolve

    a, b = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).T
    rows, columns = np.concatenate([a, b]), np.concatenate([b, a])
    links = coo_matrix((np.ones(len(rows)), (rows, columns)), (len(uv), len(uv))).tocsr()
    degree = np.asarray(links.sum(axis=1)).reshape(-1)
    laplace = (diags(degree) - links).tocsr()
    known = -laplace[inner][:, ~inner] @ uv[~inner]
    return np.asarray(spsolve(laplace[inner][:, inner].tocsc(), known)).reshape(-1, 2)
