"""Where an edge meets the surface of a face: all places, by boxes and cones that are halved.

A pair of a piece and a cell whose boxes are apart holds no place. Where no direction of the piece
lies in a tangent plane of the cell it holds one at most: Newton finds it, or the pair is halved
until its boxes are apart. Pairs that stay undecided down to ``SMALLEST`` touch, or lie on each
other: they are returned.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.geometry.small_matrices import norm
from surfmesh.intersection.bounds import Boxes, overlap, pierces_surely
from surfmesh.intersection.cells import EdgeCells, FaceCells, Numbered, Pairs
from surfmesh.intersection.newton import Curve, pulled_onto_curve, unit_normals
from surfmesh.intersection.touching import touch_of_curve

LEVELS = 30
"""Halvings at most."""

MOST_PAIRS = 3000
"""Undecided pairs of one level: more of them lie on a common curve."""

AROUND = 0.05
"""Of a piece or cell: how far outside it a place still answers for it."""

TANGENT = 1e-6
"""Sine between an edge and a surface below which it touches."""

SMALLEST = 100.0
"""Times what is the same: pairs so small are not halved."""

BESIDE = 1e5
"""Times what is the same: undecided pairs so near to a touch are due to it."""

TRIED = 40
"""Undecided pairs that a touch is looked for from."""


class Crossings(NamedTuple):
    """Places where an edge meets a surface: it goes through, or only touches it.

    fraction: (n,) of the edge's range. uv: (n, 2). point: (n, 3). touches: of each, whether it
    touches. along: (3,) a place where the edge runs along the surface, None for none.
    """

    fraction: np.ndarray
    uv: np.ndarray
    point: np.ndarray
    touches: np.ndarray
    along: np.ndarray | None


def crossings(edge: CadEdge, cells: FaceCells, same: float) -> Crossings:
    """All places where an edge, not degenerate, meets the surface over the box of a face.

    same: model units; places nearer than that are one, and gaps below a hundredth of it none.
    """
    pairs = Pairs.of(EdgeCells(edge), cells)
    found = _Found(same, cells.width)
    reach = same + edge.tolerance
    for _ in range(LEVELS):
        own = Numbered(pairs.one, pairs.a, pairs.level_a)
        other = Numbered(cells, pairs.b, pairs.level_b)
        meet = np.flatnonzero(
            overlap(_wider(own.boxes, reach), own.of, other.boxes, other.of, other.cones)
        )
        pairs = pairs.kept(meet)
        if not len(pairs):
            return found.crossings(None)
        surely = pierces_surely(own.cones, own.of[meet], other.cones, other.of[meet])
        undecided = ~(surely & _answered(edge, pairs, found))
        pairs, rows = pairs.kept(undecided), meet[undecided]
        if not len(pairs):
            return found.crossings(None)
        sizes = own.size(rows), other.size(rows)
        if len(pairs) > MOST_PAIRS or max(sizes) < SMALLEST * same:
            break
        pairs = pairs.halved(*sizes)
    return found.crossings(_touched(edge, pairs, found))


def _touched(edge: CadEdge, pairs: Pairs, found: _Found) -> np.ndarray | None:
    """Find the touches behind undecided pairs; a place that no touch explains, or None."""
    middle = pairs.middles
    points = edge.evaluate(middle[:, 0], 0)[0]
    rows = np.unique(np.linspace(0, len(pairs) - 1, min(len(pairs), TRIED)).astype(int))
    near: list[np.ndarray] = []
    for k in rows:
        touch = touch_of_curve(by_fraction(edge), pairs.other.surface, middle[k])
        if not touch.found or touch.gap > found.same:
            continue
        near.append(touch.point)
        if touch.gap <= 0.01 * found.same or not found.is_near(touch.point):
            found.add(touch.place[0], touch.place[1:], touch.point, touches=True)
    far = np.ones(len(points), bool)
    for point in near:
        far &= np.linalg.norm(points - point, axis=1) > BESIDE * found.same
    return points[far][0] if far.any() else None


def by_fraction(edge: CadEdge) -> Curve:
    """The curve of an edge, by fractions of its range."""

    def curve(fraction: np.ndarray, order: int) -> tuple[np.ndarray, ...]:
        values = edge.evaluate(fraction, order)
        rate = edge.t1 - edge.t0
        return tuple(value * rate**k for k, value in enumerate(values))

    return curve


def _answered(edge: CadEdge, pairs: Pairs, found: _Found) -> np.ndarray:
    """For each pair, has it, or nearly, a place? Those are kept."""
    low, high = pairs.corners
    middle, half, cells = 0.5 * (low + high), 0.5 * (high - low), pairs.other
    t, uv, point, gap = pulled_onto_curve(edge, cells.surface, middle[:, 0], middle[:, 1:])
    off = np.abs(np.column_stack([t, uv]) - middle) - half * (1.0 + 2.0 * AROUND)
    near = (off <= 1e-12 * np.array([1.0, *cells.width])).all(axis=1)
    # an end may come short of the surface by its tolerance
    ends = ((t == 0.0) | (t == 1.0)) & (gap <= found.same + edge.tolerance)
    there = near & (ends | (gap <= 0.01 * found.same))
    sine = np.abs(_sines(edge, cells, t, uv))
    # near a touch gaps are small all along
    crosses = (sine > TANGENT) & (ends | (gap <= found.same * sine))
    for k in np.flatnonzero(there & crosses):
        found.add(t[k], uv[k], point[k])
    return there & crosses


def _wider(boxes: Boxes, room: float) -> Boxes:
    return Boxes(boxes.low - room, boxes.high + room, boxes.corners, boxes.sag + room)


def _sines(edge: CadEdge, cells: FaceCells, t: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """(n,) of the angles at which an edge goes through a surface."""
    way = edge.evaluate(t, 1)[1]
    normal = unit_normals(cells.surface, uv)
    speed = np.maximum(np.linalg.norm(way, axis=1), 1e-300)
    return np.einsum("ij,ij->i", way, normal) / speed


class _Found:
    """Places so far, each once."""

    def __init__(self, same: float, width: np.ndarray) -> None:
        self.same, self.width = same, width
        self.fraction: list[float] = []
        self.uv: list[np.ndarray] = []
        self.point: list[np.ndarray] = []
        self.touches: list[bool] = []

    def add(
        self, fraction: float, uv: np.ndarray, point: np.ndarray, touches: bool = False
    ) -> None:
        for k, other in enumerate(self.point):
            apart = np.abs((self.uv[k] - uv) / self.width).max()
            near = norm(other - point) <= (100.0 if touches else 1.0) * self.same
            if near and abs(self.fraction[k] - fraction) < 1e-3 and apart < 1e-2:
                return
        self.fraction.append(float(fraction))
        self.uv.append(uv)
        self.point.append(point)
        self.touches.append(touches)

    def is_near(self, point: np.ndarray) -> bool:
        """Is a place known so near that it is what touches there?"""
        return any(norm(other - point) <= BESIDE * self.same for other in self.point)

    def crossings(self, along: np.ndarray | None) -> Crossings:
        order = np.argsort(self.fraction, kind="stable")
        return Crossings(
            np.array(self.fraction)[order],
            np.array(self.uv).reshape(-1, 2)[order],
            np.array(self.point).reshape(-1, 3)[order],
            np.array(self.touches, bool)[order],
            along,
        )
