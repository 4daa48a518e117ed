"""Tips of a face so thin that no ring of wanted edges fits round them: a few long triangles.

        pole                 Where a tube closes with a cusp, or is far thinner than the triangles
       / | \\                 are long, isotropic triangles would become smaller without end towards
      o--o--o  level 1       the tip. There rings of COLUMNS nodes stand at the nodes of the edges
      |\\ |\\ |                that meet in the pole, with long triangles between them. What is
      o--o--o  the ring      left of the face, beyond the last ring, is meshed as all others are.
     /   |   \\
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from surfmesh.geometry.surface import Surface
from surfmesh.meshing.face_data import FaceJob, FaceMesh, Piece

COLUMNS = 6
"""Triangles round a full tip: so many normals turn from one to the next by 60 degrees."""

FEWEST = 2.5
"""A level whose way round is less than so many steps along the edges is thin."""

THIN, THIN_CHORDS = 0.6, 4.0 * np.pi
"""And less than this share of a step, or so many chords: wider tips are owed a good shape."""

WAY = 33
"""Samples of the way round at a level."""


@dataclass(frozen=True)
class Tip:
    """Where the two pieces beside a degenerate one are cut off: ``levels`` nodes from the pole.

    left: the piece that ends at the pole, as far as the ring, from the pole outward; right: the
    one that starts there. slots: of their nodes in the job. The ring runs from left to right.
    """

    left: Piece
    right: Piece
    left_slots: np.ndarray
    right_slots: np.ndarray
    fractions: np.ndarray
    """(c + 1,) of the way round at which columns stand, from 0 to 1."""

    def columns(self) -> list[np.ndarray]:
        """(levels + 1, 2) each: (u, v) of the nodes from the pole outward, column by column."""
        left, right = self.left.uv, self.right.uv
        share = _shares(self.left.points)
        beside = np.stack(
            [np.interp(share, _shares(self.right.points), right[:, k]) for k in (0, 1)], axis=1
        )
        inner = [left + f * (beside - left) for f in self.fractions[1:-1]]
        return [left, *inner, right]


def _shares(points: np.ndarray) -> np.ndarray:
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return length / max(length[-1], np.finfo(float).tiny)


def without_tips(job: FaceJob) -> tuple[FaceJob, list[Tip], np.ndarray]:
    """The job with its thin tips cut off; the tips; for each slot of the new job the old one.

    The nodes of rings have no old slot: -1. A job that is nothing but tips keeps no loops.
    """
    loops, slots, tips = [], [], []
    slot = 0
    following = 1 + max(int(piece.numbers.max()) for loop in job.loops for piece in loop)
    for loop in job.loops:
        pieces = list(loop)
        places = []
        for piece in pieces:
            places.append(slot + np.arange(len(piece.numbers)))
            slot += len(piece.numbers)
        for at in [k for k, piece in enumerate(pieces) if piece.degenerate and len(loop) > 2]:
            before, after = (at - 1) % len(pieces), (at + 1) % len(pieces)
            tip = _tip(job, pieces[before], pieces[after], places[before], places[after])
            if tip is None:
                continue
            tips.append(tip)
            ring = _ring(job.surface, tip, following)
            following += len(ring.numbers) - 2
            cut = len(tip.left.uv) - 1, len(tip.right.uv) - 1
            pieces[before], places[before] = _shortened(pieces[before], places[before], 0, cut[0])
            pieces[after], places[after] = _shortened(pieces[after], places[after], cut[1], 0)
            pieces[at] = ring
            places[at] = np.r_[places[before][-1], np.full(len(ring.uv) - 2, -1), places[after][0]]
        kept = [k for k, piece in enumerate(pieces) if len(piece.numbers) > 1]
        loops.append(tuple(pieces[k] for k in kept))
        slots += [places[k] for k in kept]
    if not tips:
        return job, [], np.arange(slot)
    return replace(job, loops=tuple(loops)), tips, np.concatenate(slots)


def _shortened(
    piece: Piece, places: np.ndarray, first: int, last: int
) -> tuple[Piece, np.ndarray]:
    """The piece without so many of its first and last segments: one node may be all that is left."""
    part = slice(first, len(piece.numbers) - last)
    short = replace(
        piece, uv=piece.uv[part], numbers=piece.numbers[part], points=piece.points[part],
        sizes=piece.sizes[part],
    )  # fmt: skip
    return short, places[part]


def _tip(
    job: FaceJob, before: Piece, after: Piece, before_slots: np.ndarray, after_slots: np.ndarray
) -> Tip | None:
    """The thin tip between two pieces that meet in a pole; None when it is not thin."""
    if before.degenerate or after.degenerate:
        return None
    seam = before.numbers[0] == after.numbers[-1] and len(before.numbers) == len(after.numbers)
    most = min(len(before.numbers), len(after.numbers)) - 2  # a part of the face is left
    if most < 1:
        return None
    left, right = before.uv[::-1], after.uv
    points = before.points[::-1]
    way = _ways(job.surface, left[: most + 1], right[: most + 1])
    step = np.linalg.norm(np.diff(points[: most + 2], axis=0), axis=1)
    step = np.minimum(step[:most], np.r_[step[1:], step[-1:]][:most])
    owed = THIN * step
    if job.sizing.chord is not None:
        owed = np.maximum(owed, THIN_CHORDS * job.sizing.chord)
    thin = (way[1:] < FEWEST * step) & (way[1:] < owed)
    levels = int(np.argmin(thin)) if not thin.all() else most
    if not levels:
        return None
    turn = _turn(job.surface, left[levels], right[levels])
    columns = max(1, int(np.ceil(COLUMNS * turn / (2.0 * np.pi) - 1e-6)))
    if seam:
        columns = max(columns, 3)
    one, _ = _shortened(before, before_slots, len(before.numbers) - 1 - levels, 0)
    one = replace(
        one, uv=one.uv[::-1], numbers=one.numbers[::-1], points=one.points[::-1],
        sizes=one.sizes[::-1],
    )  # fmt: skip
    other, other_slots = _shortened(after, after_slots, 0, len(after.numbers) - 1 - levels)
    slots = before_slots[::-1][: levels + 1]
    return Tip(one, other, slots, other_slots, np.linspace(0.0, 1.0, columns + 1))


def _way(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """(n, WAY, 2): the ways round from nodes (n, 2) on the left to those on the right."""
    t = np.linspace(0.0, 1.0, WAY)[:, None]
    return left[:, None] + t * (right - left)[:, None]


def _ways(surface: Surface, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Lengths (n,) in space of the ways round."""
    way = _way(left, right)
    points = surface.evaluate(way.reshape(-1, 2), 0)[0].reshape(len(way), WAY, 3)
    return np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1)


def _turn(surface: Surface, left: np.ndarray, right: np.ndarray) -> float:
    """By how much the way round turns, radians."""
    points = surface.evaluate(_way(left[None], right[None])[0], 0)[0]
    step = np.diff(points, axis=0)
    step /= np.maximum(np.linalg.norm(step, axis=1), np.finfo(float).tiny)[:, None]
    cosine = np.einsum("ij,ij->i", step[1:], step[:-1])
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)).sum()) * WAY / (WAY - 2)


def _ring(surface: Surface, tip: Tip, following: int) -> Piece:
    """The last level of a tip as a piece of the boundary of what is left, from left to right."""
    uv = np.array([column[-1] for column in tip.columns()])
    (points,) = surface.evaluate(uv, 0)
    points[0], points[-1] = tip.left.points[-1], tip.right.points[-1]
    numbers = following + np.arange(-1, len(uv) - 1)
    numbers[0], numbers[-1] = tip.left.numbers[-1], tip.right.numbers[-1]
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    sizes = np.minimum(np.r_[step[:1], step], np.r_[step, step[-1:]])
    sizes[0] = min(sizes[0], tip.left.sizes[-1])
    sizes[-1] = min(sizes[-1], tip.right.sizes[-1])
    return Piece(uv, numbers, points, sizes)


def with_tips(job: FaceJob, rest: FaceJob, mesh: FaceMesh, tips: list[Tip], old: np.ndarray) -> FaceMesh:
    """The mesh of a job: ``mesh`` is that of the ``rest``, which ``without_tips`` left of it."""
    surface = job.surface
    names, new_names = (
        np.concatenate([piece.numbers for loop in one.loops for piece in loop])
        for one in (job, rest)
    )
    rings = _rings(rest, tips)
    row_of = {
        int(new_names[slot]): row for row, slot in enumerate(mesh.slots.tolist()) if slot >= 0
    }
    slots = np.where(mesh.slots >= 0, old[mesh.slots], -1)
    fresh = _Rows(len(mesh.points), len(mesh.uv_points), row_of)
    for tip, ring in zip(tips, rings):
        _fill(surface, tip, ring, names, fresh)
    if not fresh.triangles:
        return mesh
    triangles, uv_triangles = np.array(fresh.triangles), np.array(fresh.uv_triangles)
    inverse = mesh.inverse_sizes
    if inverse is not None:
        size = np.array(fresh.uv_sizes)[:, None]
        inverse = np.concatenate([inverse, np.array([1.0, 0.0, 0.0, 1.0, 0.0, 1.0]) / size])
    return replace(
        mesh,
        points=np.concatenate([mesh.points, np.array(fresh.points).reshape(-1, 3)]),
        slots=np.concatenate([slots, np.array(fresh.slots, np.int64)]),
        triangles=np.concatenate([mesh.triangles, triangles]).astype(np.int32),
        uv_points=np.concatenate([mesh.uv_points, np.array(fresh.uv)]),
        uv_triangles=np.concatenate([mesh.uv_triangles, uv_triangles]).astype(np.int32),
        sizes=np.concatenate([mesh.sizes, np.array(fresh.sizes)]),
        inverse_sizes=inverse,
    )


def _rings(rest: FaceJob, tips: list[Tip]) -> list[Piece]:
    """The ring of each tip among the pieces of what is left."""
    pieces = [piece for loop in rest.loops for piece in loop]
    return [
        next(p for p in pieces if len(p.uv) == len(tip.fractions) and (p.uv[0] == tip.left.uv[-1]).all()
             and (p.uv[-1] == tip.right.uv[-1]).all())
        for tip in tips
    ]  # fmt: skip


class _Rows:
    """Points and triangles that are added, by row."""

    def __init__(self, points: int, uv_points: int, row_of: dict[int, int]) -> None:
        self.first, self.first_uv, self.row_of = points, uv_points, row_of
        self.points: list[np.ndarray] = []
        self.slots: list[int] = []
        self.sizes: list[float] = []
        self.uv: list[np.ndarray] = []
        self.uv_sizes: list[float] = []
        self.triangles: list[list[int]] = []
        self.uv_triangles: list[list[int]] = []

    def point(self, number: int | None, point: np.ndarray, slot: int, size: float) -> int:
        """Row of a point; those with a number are there once."""
        if number is not None and number in self.row_of:
            return self.row_of[number]
        self.points.append(point)
        self.slots.append(slot)
        self.sizes.append(size)
        row = self.first + len(self.points) - 1
        if number is not None:
            self.row_of[number] = row
        return row

    def place(self, uv: np.ndarray, size: float) -> int:
        self.uv.append(uv)
        self.uv_sizes.append(size)
        return self.first_uv + len(self.uv) - 1

    def triangle(self, corners: list[tuple[int, int]]) -> None:
        """A triangle of corners (row, place), turned counter-clockwise in (u, v)."""
        a, b, c = (self.uv[place - self.first_uv] for _, place in corners)
        (bu, bv), (cu, cv) = b - a, c - a
        if bu * cv - bv * cu < 0.0:
            corners = corners[::-1]
        self.triangles.append([row for row, _ in corners])
        self.uv_triangles.append([place for _, place in corners])


def _fill(surface: Surface, tip: Tip, ring: Piece, names: np.ndarray, rows: _Rows) -> None:
    """The triangles between the columns of a tip, from the pole to the ring."""
    columns = tip.columns()
    step = np.linalg.norm(np.diff(tip.left.points, axis=0), axis=1)
    sizes = np.maximum(np.r_[step[:1], step], np.r_[step, step[-1:]])
    grid: list[list[tuple[int, int]]] = []
    for k, column in enumerate(columns):
        (points,) = surface.evaluate(column, 0)
        own = []
        for level, (uv, point) in enumerate(zip(column, points)):
            size = float(sizes[min(level, len(sizes) - 1)])
            number, slot = None, -1
            if k in (0, len(columns) - 1) or level == 0:
                side, slots = (tip.right, tip.right_slots) if k else (tip.left, tip.left_slots)
                slot = int(slots[level])
                number, point = int(names[slot]), side.points[level]
            elif level == len(column) - 1:
                number = int(ring.numbers[k])
            own.append((rows.point(number, point, slot, size), rows.place(uv, size)))
        grid.append(own)
    for k, (one, other) in enumerate(zip(grid, grid[1:])):
        middle = 0.5 * (columns[k][0] + columns[k + 1][0])
        pole = (one[0][0], rows.place(middle, float(sizes[0])))
        _zip([pole, *one[1:]], [pole, *other[1:]], rows)


def _zip(one: list[tuple[int, int]], other: list[tuple[int, int]], rows: _Rows) -> None:
    """Triangles between two columns of nodes (row, place) that begin in the same one."""
    i = k = 0
    share_left = np.linspace(0.0, 1.0, len(one))
    share_right = np.linspace(0.0, 1.0, len(other))
    while i < len(one) - 1 or k < len(other) - 1:
        ahead = i < len(one) - 1 and (
            k == len(other) - 1 or share_left[i + 1] <= share_right[k + 1]
        )
        corners = [one[i], other[k], one[i + 1] if ahead else other[k + 1]]
        if ahead:
            i += 1
        else:
            k += 1
        if len({row for row, _ in corners}) < 3:
            continue
        rows.triangle(corners)
