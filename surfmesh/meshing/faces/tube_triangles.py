"""The long triangles of thin tips and necks, put beside the mesh of what is left of a face."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from surfmesh.geometry.surface import Surface
from surfmesh.meshing.faces.face_data import FaceJob, FaceMesh
from surfmesh.meshing.faces.thin_tubes import Tube

Corner = tuple[int, int]
"""Rows of a point in space and of its parameters."""


def with_tubes(
    job: FaceJob, rest: FaceJob, mesh: FaceMesh, tubes: list[Tube], old: np.ndarray
) -> FaceMesh:
    """The mesh of a job: ``mesh`` is that of the ``rest``, which ``without_tubes`` left of it.

    old: the slots of the job for those of the rest.
    """
    numbers = [piece.numbers for loop in rest.loops for piece in loop]
    names = np.concatenate([np.empty(0, np.int64), *numbers])
    rows = _Rows(len(mesh.points), len(mesh.uv_points))
    rows.row_of = {
        int(names[slot]): row for row, slot in enumerate(mesh.slots.tolist()) if slot >= 0
    }
    for tube in tubes:
        _fill(job.surface, tube, rows)
    inverse = mesh.inverse_sizes
    if inverse is not None:
        size = np.array(rows.uv_sizes)[:, None]
        inverse = np.concatenate([inverse, np.array([1.0, 0.0, 0.0, 1.0, 0.0, 1.0]) / size])
    slots = np.array([old[slot] if slot >= 0 else -1 for slot in mesh.slots.tolist()], np.int64)
    triangles = np.concatenate([mesh.triangles, np.array(rows.triangles)])
    uv_triangles = np.concatenate([mesh.uv_triangles, np.array(rows.uv_triangles)])
    return replace(
        mesh,
        points=np.concatenate([mesh.points, np.array(rows.points).reshape(-1, 3)]),
        slots=np.concatenate([slots, np.array(rows.slots, np.int64)]),
        triangles=triangles.astype(np.int32),
        uv_points=np.concatenate([mesh.uv_points, np.array(rows.uv)]),
        uv_triangles=uv_triangles.astype(np.int32),
        sizes=np.concatenate([mesh.sizes, np.array(rows.sizes)]),
        inverse_sizes=inverse,
    )


class _Rows:
    """Points and triangles that are added, by row."""

    def __init__(self, points: int, uv_points: int) -> None:
        self.first, self.first_uv = points, uv_points
        self.row_of: dict[int, int] = {}  # of nodes with a number
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
        """Row of parameters, a new one each time."""
        self.uv.append(uv)
        self.uv_sizes.append(size)
        return self.first_uv + len(self.uv) - 1

    def triangle(self, corners: list[Corner]) -> None:
        """A triangle turned counter-clockwise in (u, v)."""
        a, b, c = (self.uv[place - self.first_uv] for _, place in corners)
        (bu, bv), (cu, cv) = b - a, c - a
        if bu * cv - bv * cu < 0.0:
            corners = corners[::-1]
        self.triangles.append([row for row, _ in corners])
        self.uv_triangles.append([place for _, place in corners])


def _fill(surface: Surface, tube: Tube, rows: _Rows) -> None:
    """The triangles between the columns of a tube."""
    step = np.linalg.norm(np.diff(tube.left.points, axis=0), axis=1)
    sizes = np.maximum(np.r_[step[:1], step], np.r_[step, step[-1:]])
    count = len(tube.columns)
    grid: list[list[Corner]] = []
    for k, column in enumerate(tube.columns):
        (points,) = surface.evaluate(column, 0)
        own = []
        for level, (uv, point) in enumerate(zip(column, points)):
            size = float(sizes[min(level, len(sizes) - 1)])
            number, slot = None, -1
            start, end = level == 0, level == len(column) - 1
            at_pole = (start and tube.first is None) or (end and tube.last is None)
            if k in (0, count - 1) or at_pole:
                side, slots = (tube.right, tube.right_slots) if k else (tube.left, tube.left_slots)
                place = -1 if end else level
                slot, point = int(slots[place]), side.points[place]
                number = int(side.numbers[place])
            elif start and tube.first is not None:
                number = int(tube.first.numbers[count - 1 - k])
            elif end and tube.last is not None:
                number = int(tube.last.numbers[k])
            own.append((rows.point(number, point, slot, size), rows.place(uv, size)))
        grid.append(own)
    for k, (one, other) in enumerate(pairwise(grid)):
        for level, ring in ((0, tube.first), (-1, tube.last)):
            if ring is None:  # a pole is between the columns in (u, v)
                middle = 0.5 * (tube.columns[k][level] + tube.columns[k + 1][level])
                one[level] = other[level] = (one[level][0], rows.place(middle, float(sizes[level])))
        _zip(list(one), list(other), rows)


def _zip(one: list[Corner], other: list[Corner], rows: _Rows) -> None:
    """Triangles between two columns of nodes."""
    i = k = 0
    while i < len(one) - 1 or k < len(other) - 1:
        ahead = k == len(other) - 1
        if i < len(one) - 1 and not ahead:
            ahead = (i + 1) * (len(other) - 1) <= (k + 1) * (len(one) - 1)
        corners = [one[i], other[k], one[i + 1] if ahead else other[k + 1]]
        i, k = (i + 1, k) if ahead else (i, k + 1)
        if len({row for row, _ in corners}) == 3:
            rows.triangle(corners)
