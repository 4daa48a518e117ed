"""Where two edges meet: ends on each other, crossings, touches; and where they run together.

Two edges that are one curve over some length part at the end of one of them, as lines, conics
and splines without kinks do; so the ends tell where. Elsewhere both are halved: cells whose boxes
are apart do not meet, cells of which no directions are parallel meet once at most.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.geometry.small_matrices import least_squares, norm, product
from surfmesh.intersection.bounds import Boxes, cross_surely
from surfmesh.intersection.cells import EdgeCells, Numbered

SEARCHED = 129
"""Points of an edge among which the nearest to a point is looked for first."""

TOGETHER = np.array([0.237, 0.5, 0.731])
"""Of a part of an edge: where it is looked whether it lies on another."""

LEVELS, MOST_PAIRS = 40, 400
"""Halvings, and pairs of one level, at most."""

SMALLEST = 100.0
"""Times what is the same: pairs so small are not halved."""

AROUND = 0.05
"""Of a cell: how far outside it a place still answers for it."""

PARALLEL = 1e-9
"""Sine between lines that never cross."""

TANGENT = 1e-6
"""Sine between edges below which they touch."""

STEPS = 20
TRIED = 12
"""Undecided pairs that a touch is looked for from."""


def nearest_on_edge(edge: CadEdge, point: np.ndarray) -> tuple[float, float]:
    """The fraction of an edge nearest to a point, and the distance."""
    fractions = np.linspace(0.0, 1.0, SEARCHED)
    distance = np.linalg.norm(edge.evaluate(fractions, 0)[0] - point, axis=1)
    t = fractions[int(np.argmin(distance))]
    rate = edge.t1 - edge.t0
    for _ in range(12):
        c, first, second = edge.evaluate(np.array([t]), 2)
        step, d1, d2 = c[0] - point, first[0] * rate, second[0] * rate**2
        slope, bend = float(product(step, d1)), float(product(d1, d1) + product(step, d2))
        if not bend > 0.0:
            bend = float(product(d1, d1))
        if not bend > 0.0:
            break
        after = min(max(t - slope / bend, 0.0), 1.0)
        moved, t = abs(after - t), after
        if moved < 1e-16:
            break
    return float(t), norm(edge.evaluate(np.array([t]), 0)[0][0] - point)


def runs_along(one: CadEdge, other: CadEdge, first: float, last: float, reach: float) -> bool:
    """Does the part of an edge between two fractions lie on another edge?"""
    points = one.evaluate(first + TOGETHER * (last - first), 0)[0]
    return all(nearest_on_edge(other, point)[1] <= reach for point in points)


def meetings(a: CadEdge, b: CadEdge, same: float) -> list[tuple[float, float]]:
    """All places (fraction of a, fraction of b) where two edges meet; of parts that run together
    the ends.

    same: model units; places nearer than that are one. Neither edge is degenerate.
    """
    reach = same + a.tolerance + b.tolerance
    found = list(_ends_on_each_other(a, b, reach))
    if a.is_straight and b.is_straight:
        found += _lines_cross(a, b, reach)
    else:
        stops = np.unique([0.0, *(t for t, _ in found), 1.0])
        together = [
            (t0, t1) for t0, t1 in pairwise(stops.tolist())
            if t1 - t0 > 1e-12 and runs_along(a, b, t0, t1, reach)
        ]  # fmt: skip
        found += _Halving(a, b, same, reach, together).places()
    return found


def _ends_on_each_other(a: CadEdge, b: CadEdge, reach: float) -> Iterator[tuple[float, float]]:
    ends = np.array([0.0, 1.0])
    for fraction, point in zip(ends, a.evaluate(ends, 0)[0]):
        on, distance = nearest_on_edge(b, point)
        if distance <= reach:
            yield float(fraction), on
    for fraction, point in zip(ends, b.evaluate(ends, 0)[0]):
        on, distance = nearest_on_edge(a, point)
        if distance <= reach:
            yield on, float(fraction)


def _lines_cross(a: CadEdge, b: CadEdge, reach: float) -> list[tuple[float, float]]:
    (p, p1), (q, q1) = (edge.evaluate(np.array([0.0, 1.0]), 0)[0] for edge in (a, b))
    d, e = p1 - p, q1 - q
    across = np.cross(d, e)
    square = float(product(across, across))
    if square <= (PARALLEL**2) * float(product(d, d)) * float(product(e, e)):
        return []
    t = float(product(np.cross(q - p, e), across)) / square
    s = float(product(np.cross(q - p, d), across)) / square
    gap = norm(p + t * d - q - s * e)
    return [(t, s)] if gap <= reach and 0.0 <= t <= 1.0 and 0.0 <= s <= 1.0 else []


class _Halving:
    """Crossings and touches of two edges away from where they run together."""

    def __init__(
        self, a: CadEdge, b: CadEdge, same: float, reach: float,
        together: list[tuple[float, float]],
    ) -> None:  # fmt: skip
        self.a, self.b, self.same, self.reach, self.together = a, b, same, reach, together
        self.cells = EdgeCells(a), EdgeCells(b)
        self.found: list[tuple[float, float]] = []

    def places(self) -> list[tuple[float, float]]:
        one, other = self.cells
        i, j = (k.ravel() for k in np.meshgrid(one.start()[:, 0], other.start()[:, 0]))
        for level in range(LEVELS):
            first = Numbered(one, i[:, None], level)
            second = Numbered(other, j[:, None], level)
            keep = _near(first.boxes, first.of, second.boxes, second.of, self.reach)
            keep &= ~self._is_together(one, i, level)
            rows = np.flatnonzero(keep)
            i, j = i[rows], j[rows]
            if not len(i):
                return self.found
            surely = cross_surely(first.cones, first.of[rows], second.cones, second.of[rows])
            undecided = ~(surely & self._answered(i, j, level))
            i, j, rows = i[undecided], j[undecided], rows[undecided]
            if not len(i):
                return self.found
            size = max(first.size(rows), second.size(rows))
            if size < SMALLEST * self.same or len(i) > MOST_PAIRS:
                break
            i = np.repeat(2 * i[:, None] + [0, 1], 2, axis=1).ravel()
            j = np.tile(2 * j[:, None] + [0, 1], 2).ravel()
        self._find_touches(i, j, level)
        return self.found

    def _is_together(self, cells: EdgeCells, i: np.ndarray, level: int) -> np.ndarray:
        low, high = cells.corners(i[:, None], level)
        inside = np.zeros(len(i), bool)
        for first, last in self.together:
            inside |= (low[:, 0] >= first - 1e-9) & (high[:, 0] <= last + 1e-9)
        return inside

    def _middles(self, i: np.ndarray, j: np.ndarray, level: int) -> tuple[np.ndarray, np.ndarray]:
        (low, high), (low_2, high_2) = (
            cells.corners(k[:, None], level) for cells, k in zip(self.cells, (i, j))
        )
        return 0.5 * (low + high)[:, 0], 0.5 * (low_2 + high_2)[:, 0]

    def _answered(self, i: np.ndarray, j: np.ndarray, level: int) -> np.ndarray:
        """For each pair, has it, or nearly, a place? Those are kept."""
        t, s = self._middles(i, j, level)
        width = 1.0 / (len(self.cells[0].start()) * 2.0**level)
        at_a, at_b, crosses = self._pulled(t, s)
        off = np.maximum(np.abs(at_a - t), np.abs(at_b - s))
        answered = crosses & (off <= (0.5 + AROUND) * width + 1e-12)
        for k in np.flatnonzero(answered):
            self._add(float(at_a[k]), float(at_b[k]))
        return answered

    def _pulled(self, t: np.ndarray, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Fractions (n,) of both near guesses where they come nearest to each other by Newton's
        method, and whether they cross there."""
        rates = [edge.t1 - edge.t0 for edge in (self.a, self.b)]
        for _ in range(STEPS):
            p, p1 = self.a.evaluate(t, 1)
            q, q1 = self.b.evaluate(s, 1)
            p1, q1, gap = p1 * rates[0], q1 * rates[1], p - q
            e, f, g = (np.einsum("ij,ij->i", x, y) for x, y in ((p1, p1), (p1, q1), (q1, q1)))
            x, y = (np.einsum("ij,ij->i", way, gap) for way in (p1, q1))
            square = np.maximum(e * g - f * f, 1e-14 * e * g + 1e-300)  # nearly parallel: small
            after_t = np.clip(t - (g * x - f * y) / square, 0.0, 1.0)
            after_s = np.clip(s - (f * x - e * y) / square, 0.0, 1.0)
            moved = np.maximum(np.abs(after_t - t), np.abs(after_s - s)).max(initial=0.0)
            t, s = after_t, after_s
            if moved < 1e-15:
                break
        p, p1 = self.a.evaluate(t, 1)
        q, q1 = self.b.evaluate(s, 1)
        speed = np.linalg.norm(p1, axis=1) * np.linalg.norm(q1, axis=1)
        sine = np.linalg.norm(np.cross(p1, q1), axis=1) / np.maximum(speed, 1e-300)
        # near a touch gaps are small all along
        gap = np.linalg.norm(p - q, axis=1)
        return t, s, (sine > TANGENT) & (gap <= self.reach * sine)

    @staticmethod
    def _at(edge: CadEdge, t: float, order: int) -> list[np.ndarray]:
        rate = edge.t1 - edge.t0
        values = edge.evaluate(np.array([t]), order)
        return [value[0] * rate**k for k, value in enumerate(values)]

    def _find_touches(self, i: np.ndarray, j: np.ndarray, level: int) -> None:
        t, s = self._middles(i, j, level)
        rows = np.unique(np.linspace(0, len(i) - 1, min(len(i), TRIED)).astype(int))
        for k in rows:
            at = self._touch(float(t[k]), float(s[k]))
            if at is not None:
                self._add(*at)

    def _touch(self, t: float, s: float) -> tuple[float, float] | None:
        """Where they have one direction: (a - b) . a' = 0, the part of b' across a' is none."""
        for _ in range(STEPS):
            p, p1, p2 = self._at(self.a, t, 2)
            q, q1, q2 = self._at(self.b, s, 2)
            away, across = p - q, np.cross(p1, q1)
            value = np.array([product(away, p1), *across])
            slope = np.column_stack([
                [product(p1, p1) + product(away, p2), *np.cross(p2, q1)],
                [-product(q1, p1), *np.cross(p1, q2)],
            ])  # fmt: skip
            scale = np.array([norm(p1), *[norm(p1)] * 3])
            step = least_squares(slope / scale[:, None], value / scale, 1e-10)
            after_t, after_s = min(max(t - step[0], 0.0), 1.0), min(max(s - step[1], 0.0), 1.0)
            moved = max(abs(after_t - t), abs(after_s - s))
            t, s = after_t, after_s
            if moved < 1e-15:
                break
        gap = norm(self._at(self.a, t, 0)[0] - self._at(self.b, s, 0)[0])
        return (float(t), float(s)) if gap <= self.reach else None

    def _add(self, t: float, s: float) -> None:
        point = self._at(self.a, t, 0)[0]
        for other, _ in self.found:
            near = norm(self._at(self.a, other, 0)[0] - point) <= 100.0 * self.same
            if near and abs(other - t) < 1e-3:
                return
        self.found.append((t, s))


def _near(one: Boxes, i: np.ndarray, other: Boxes, j: np.ndarray, room: float) -> np.ndarray:
    below = (one.low[i] <= other.high[j] + room).all(axis=1)
    return below & (other.low[j] <= one.high[i] + room).all(axis=1)
