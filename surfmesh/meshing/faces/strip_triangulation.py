"""Faces without inside: triangles between the nodes of two sides that face each other.

a0 --- a1 ---- a2 ---- a3         rungs a-b between mates; one to three triangles between
|    / |    /  |    /  |          a rung and the next. Where the surface turns too far on
b0 --- b1 ---- b2 ---- b3         the way across, a rung is a column of several nodes:

o --- o --- o --- o               a tube with its seam as both sides has four of them
|  /  |  /  |  /  |               round it; the columns at the ends are the nodes of the
o --- o --- o --- o               edges there, however many
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from surfmesh._core import elementary_functions
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import norm
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.edges.polygon_lengths import fractions_along
from surfmesh.meshing.faces.face_data import CoedgeNodes, FaceJob, FaceMesh

TURN_ACROSS = 0.5 * math.pi
"""Radians: no triangle spans a wider turn of the surface on the way across."""

LEAST_COSINE = 0.5
"""Of the angle between a triangle and the surface: beyond it counts as folded."""

SAMPLES = 9
"""Points on the way across at which the surface's normal is asked for."""


class Nodes(NamedTuple):
    """Nodes of a chain: slots (n,) in the job, -1 inside; numbers (n,); points; uv; sizes."""

    slots: np.ndarray
    numbers: np.ndarray
    points: np.ndarray
    uv: np.ndarray
    sizes: np.ndarray

    def taken(self, rows: list[int] | slice | np.ndarray) -> Nodes:
        """Some of them, or in another order."""
        return Nodes(*(column[rows] for column in self))


def strip_mesh(job: FaceJob) -> FaceMesh | None:
    """The mesh of a narrow face; None of another one, or where its triangles would be folded."""
    narrow = job.narrow
    if narrow is None:
        return None
    start = np.cumsum([0, *(len(p.numbers) for loop in job.loops for p in loop)])
    pieces = [piece for loop in job.loops for piece in loop]
    first, back = (_chain(pieces, start, side) for side in narrow.sides)
    if first is None or back is None:
        return None
    second = back.taken(slice(None, None, -1))
    if narrow.closed:
        first, second = _opened(first, second)
    rungs = rungs_between(first.points, second.points)
    columns = _columns(job, first, second, rungs)
    if narrow.closed:
        columns[-1] = columns[0]
    else:
        columns = _with_tips(columns)
        last, begin = (_chain(pieces, start, chain) for chain in narrow.ends)
        if last is not None and len(columns) > 1:
            columns[-1] = _spread(last, columns)
        if begin is not None:
            columns[0] = _spread(begin.taken(slice(None, None, -1)), columns)
    return _assembled(job.surface, columns)


def _with_tips(columns: list[Nodes]) -> list[Nodes]:
    """Where the sides start or end in one node, the column there is that node."""
    return [
        column.taken([0])
        if place in (0, len(columns) - 1) and column.numbers[0] == column.numbers[-1]
        else column
        for place, column in enumerate(columns)
    ]


def _spread(end: Nodes, columns: list[Nodes]) -> Nodes:
    """A pole as a column of as many images as the others have nodes; other ends as they are."""
    if len(np.unique(end.numbers)) > 1:
        return end
    most = max(len(column.slots) for column in columns)
    t = np.linspace(0.0, 1.0, most)[:, None]
    return end.taken(np.zeros(most, int))._replace(uv=(1.0 - t) * end.uv[0] + t * end.uv[-1])


def _chain(pieces: list[CoedgeNodes], start: np.ndarray, places: tuple[int, ...]) -> Nodes | None:
    """The nodes of some pieces one after the other, common ones once."""
    rows: list[Nodes] = []
    if len(places) > 1 and all(pieces[place].degenerate for place in places):
        places = places[:1]
    for place in places:
        piece = pieces[place]
        slots = start[place] + np.arange(len(piece.numbers))
        own = Nodes(slots, piece.numbers, piece.points, piece.uv, piece.sizes)
        if piece.degenerate and len(places) > 1:
            continue
        rows.append(own if not rows else own.taken(slice(1, None)))
    return Nodes(*map(np.concatenate, zip(*rows))) if rows else None


def _opened(first: Nodes, second: Nodes) -> tuple[Nodes, Nodes]:
    """Two closed chains, the second one begun where the first begins."""
    ring = second.taken(slice(None, -1))
    near = int(np.linalg.norm(ring.points - first.points[0], axis=1).argmin())
    return first, ring.taken(np.r_[near : len(ring.numbers), : near + 1])


def rungs_between(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Pairs (k, 2) of nodes that face each other, from (0, 0) to the last ones.

    first (n, 3), second (m, 3): points of two chains side by side. Each step goes on by a node
    on either side, or on both, to the shortest of the three rungs.
    """
    i = j = 0
    rungs = [(0, 0)]
    while i < len(first) - 1 or j < len(second) - 1:
        steps = []
        for a, b in ((1, 1), (1, 0), (0, 1)):
            if i + a < len(first) and j + b < len(second):
                length = norm(first[i + a] - second[j + b])
                steps.append((length, a, b))
        _, a, b = min(steps, key=lambda step: step[0])
        i, j = i + a, j + b
        rungs.append((i, j))
    return np.array(rungs)


def _columns(job: FaceJob, first: Nodes, second: Nodes, rungs: np.ndarray) -> list[Nodes]:
    """For every rung its two nodes, and as many between them as the surface turns."""
    a, b = first.taken(rungs[:, 0]), second.taken(rungs[:, 1])
    most = TURN_ACROSS
    if job.sizing.angle is not None:
        most = min(most, math.radians(job.sizing.angle))
    turn = turn_across(job.surface, a.uv, b.uv)
    parts = max(1, math.ceil(float(turn.max()) / most - 1e-6))
    columns = []
    t = (np.arange(1, parts) / parts)[:, None]
    for k in range(len(rungs)):
        own = a.taken([k])
        if a.numbers[k] != b.numbers[k] or not np.array_equal(a.uv[k], b.uv[k]):
            uv = (1.0 - t) * a.uv[k] + t * b.uv[k]
            inside = Nodes(
                np.full(parts - 1, -1), np.full(parts - 1, -1),
                job.surface.evaluate(uv, 0)[0] if parts > 1 else np.empty((0, 3)), uv,
                np.full(parts - 1, max(float(a.sizes[k]), float(b.sizes[k]))),
            )  # fmt: skip
            own = Nodes(*map(np.concatenate, zip(own, inside, b.taken([k]))))
        columns.append(own)
    return columns


def turn_across(surface: FaceSurface, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """By how much (n,) the normal turns on straight ways in (u, v) from (n, 2) to (n, 2)."""
    if surface.kind == "plane":
        return np.zeros(len(first))
    t = np.linspace(0.0, 1.0, SAMPLES)[:, None, None]
    uv = ((1.0 - t) * first + t * second).reshape(-1, 2)
    normal = _normals(surface, uv).reshape(SAMPLES, -1, 3)
    cosine = np.einsum("ijk,ijk->ij", normal[1:], normal[:-1])
    return elementary_functions.acos(np.clip(cosine, -1.0, 1.0)).sum(axis=0)


def _normals(surface: Surface, uv: np.ndarray) -> np.ndarray:
    """Unit normals (n, 3); zero where the surface has none."""
    _, along_u, along_v = surface.evaluate(uv, 1)
    normal = np.cross(along_u, along_v)
    length = np.linalg.norm(normal, axis=1)[:, None]
    return normal / np.where(length > 0.0, length, 1.0)


def _assembled(surface: Surface, columns: list[Nodes]) -> FaceMesh | None:
    """Triangles between every column and the next; None where one of them is folded."""
    every = Nodes(*map(np.concatenate, zip(*columns)))
    known: dict[tuple, int] = {}
    row = np.empty(len(every.slots), np.int64)  # the same node in two columns is one
    for k, (slot, uv) in enumerate(zip(every.slots.tolist(), every.uv.tolist())):
        row[k] = known.setdefault((slot, *uv) if slot >= 0 else (-1, k), k)
    names = np.where(every.slots >= 0, every.numbers, -1 - np.arange(len(row)))
    first = np.cumsum([0, *(len(column.slots) for column in columns)])
    triangles: list[tuple[int, int, int]] = []
    for k in range(len(columns) - 1):
        left, right = np.arange(*first[k : k + 2]), np.arange(*first[k + 1 : k + 3])
        triangles += zipped(every.points, left, right)
    found = row[np.array(triangles, np.int64).reshape(-1, 3)]
    corners = names[found]
    real = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    found = found[real]
    cosine = face_cosines(surface, every.points[found], every.uv[found])
    if not len(found) or not (cosine > LEAST_COSINE).all():
        return None
    kept, found = np.unique(found, return_inverse=True)
    found = found.reshape(-1, 3).astype(np.int32)
    nodes = every.taken(kept)
    return FaceMesh(nodes.points, nodes.slots, found, nodes.uv, found, nodes.sizes, narrow=True)


def zipped(points: np.ndarray, left: np.ndarray, right: np.ndarray) -> list[tuple[int, int, int]]:
    """Triangles between two chains of nodes, given as rows of points (n, 3).

    left 0 --- right 0      they turn left 0, left 1, right: the columns run from the first
         |  /  |            side of the strip, which is walked to the right with the inside
    left 1 --- right 1      on its left, to the second; that is against the picture's y
    """
    s, t = (fractions_along(points[chain]) for chain in (left, right))
    i = j = 0
    triangles = []
    while i < len(left) - 1 or j < len(right) - 1:
        if i == len(left) - 1:
            forward = False
        elif j == len(right) - 1:
            forward = True
        elif abs(s[i + 1] - t[j + 1]) > 1e-9:
            forward = bool(s[i + 1] < t[j + 1])
        else:  # the shorter diagonal
            one = norm(points[left[i + 1]] - points[right[j]])
            forward = bool(one <= norm(points[left[i]] - points[right[j + 1]]))
        if forward:
            triangles.append((int(left[i]), int(right[j]), int(left[i + 1])))
            i += 1
        else:
            triangles.append((int(left[i]), int(right[j]), int(right[j + 1])))
            j += 1
    return triangles


def face_cosines(surface: Surface, corners: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Cosines (m,) between triangles and the surface at their middles; -1: without area.

    corners (m, 3, 3), uv (m, 3, 2). Where the surface has no normal the cosine is 1.
    """
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1)
    wanted = _normals(surface, uv.mean(axis=1))
    cosine = np.einsum("ij,ij->i", normal, wanted) / np.where(length > 0.0, length, 1.0)
    return np.where(length > 0.0, np.where(wanted.any(axis=1), cosine, 1.0), -1.0)
