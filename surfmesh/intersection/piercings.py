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
from surfmesh.intersection.bounds import overlap, pierces_surely
from surfmesh.intersection.cells import EdgePieces, FaceCells, Numbered
from surfmesh.intersection.newton import pulled_onto_curve

LEVELS = 26
"""Halvings at most."""

MOST_PAIRS = 6000
"""Undecided pairs of one level: more of them lie on a common curve."""

AROUND = 0.05
"""Of a piece or cell: how far outside it a place still answers for it."""


class Crossings(NamedTuple):
    """Places where an edge meets a surface.

    fraction: (n,) of the edge's range. uv: (n, 2). point: (n, 3). touching: (3,) a place where
    the edge touches the surface or lies on it, None for none.
    """

    fraction: np.ndarray
    uv: np.ndarray
    point: np.ndarray
    touching: np.ndarray | None


def crossings(edge: CadEdge, cells: FaceCells, same: float) -> Crossings:
    """All crossings of an edge, not degenerate, with the surface over the box of a face.

    same: model units; places nearer than that are one, and gaps below a hundredth of it none.
    """
    pieces = EdgePieces(edge)
    first = pieces.start(), cells.start()
    piece, cell = (k.ravel() for k in np.meshgrid(*(np.arange(len(k)) for k in first)))
    p, c = first[0][piece], first[1][cell]
    found = _Found(same, cells.width)
    for level in range(LEVELS):
        own, other = Numbered(pieces, p, level), Numbered(cells, c, level)
        meet = overlap(own.boxes, own.of, other.boxes, other.of)
        p, c, i, j = p[meet], c[meet], own.of[meet], other.of[meet]
        if not len(p):
            return found.crossings(None)
        surely = pierces_surely(own.cones, i, other.cones, j)
        answered = _answered(edge, pieces, cells, p, c, level, found, same)
        open_pairs = ~(surely & answered)
        p, c = p[open_pairs], c[open_pairs]
        tiny = np.linalg.norm(other.boxes.high - other.boxes.low, axis=1).max() < 10.0 * same
        if len(p) > MOST_PAIRS or (tiny and len(p)):
            break
        p = np.repeat(EdgePieces.children(p), 4, axis=1).ravel()
        c = np.tile(FaceCells.children(c), (1, 2, 1)).reshape(-1, 2)
    if not len(p):
        return found.crossings(None)
    lo, hi = pieces.corners(p[:1], level)
    return found.crossings(edge.evaluate(0.5 * (lo + hi), 0)[0][0])


def _answered(
    edge: CadEdge, pieces: EdgePieces, cells: FaceCells, p: np.ndarray, c: np.ndarray,
    level: int, found: _Found, same: float,
) -> np.ndarray:  # fmt: skip
    """For each pair, has it, or nearly, a place? Those are kept."""
    lo, hi = pieces.corners(p, level)
    low, high = cells.corners(c, level)
    middle, place = 0.5 * (lo + hi), 0.5 * (low + high)

    def curve(fraction: np.ndarray, order: int) -> tuple[np.ndarray, ...]:
        values = edge.evaluate(fraction, order)
        rate = edge.t1 - edge.t0
        return tuple(value * rate**k for k, value in enumerate(values))

    t, uv, point, gap = pulled_onto_curve(curve, cells.surface, middle, place)
    half, width = 0.5 * (hi - lo), 0.5 * (high - low)
    near = (np.abs(t - middle) <= half * (1.0 + 2.0 * AROUND) + 1e-12) & (
        np.abs(uv - place) <= width * (1.0 + 2.0 * AROUND) + 1e-12 * cells.width
    ).all(axis=1)
    there = near & (gap <= 0.01 * same)
    for k in np.flatnonzero(there):
        found.add(t[k], uv[k], point[k])
    return there


class _Found:
    """Places so far, each once."""

    def __init__(self, same: float, width: np.ndarray) -> None:
        self.same, self.width = same, width
        self.fraction: list[float] = []
        self.uv: list[np.ndarray] = []
        self.point: list[np.ndarray] = []

    def add(self, fraction: float, uv: np.ndarray, point: np.ndarray) -> None:
        for k, other in enumerate(self.point):
            apart = np.abs((self.uv[k] - uv) / self.width).max()
            near = np.linalg.norm(other - point) <= self.same
            if near and abs(self.fraction[k] - fraction) < 1e-3 and apart < 1e-2:
                return
        self.fraction.append(float(fraction))
        self.uv.append(uv)
        self.point.append(point)

    def crossings(self, touching: np.ndarray | None) -> Crossings:
        order = np.argsort(self.fraction, kind="stable")
        return Crossings(
            np.array(self.fraction)[order],
            np.array(self.uv).reshape(-1, 2)[order],
            np.array(self.point).reshape(-1, 3)[order],
            touching,
        )
