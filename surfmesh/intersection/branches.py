"""All branches of the curve in which two faces meet.

open branches     from the ends that are known: where edges of one face meet the other
closed branches   found by halving pairs of (u, v) cells:

    boxes apart                           nothing there
    no normals parallel (`cross_surely`)  the surfaces cross in one curve at most, which is a
                                          graph over its direction and cannot close within the
                                          pair; Newton gives a point of it, or none, and then the
                                          pair is halved
    else                                  halved, down to SMALLEST; what remains is named: the
                                          surfaces touch there

(Sederberg and Meyers, Loop detection in surface patch intersections, CAGD 5 (1988) 161-171, is
the condition on normals.) A point on no branch so far starts a new one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from surfmesh.cad.model.cad_model import CadFace
from surfmesh.errors import SurfaceError
from surfmesh.intersection.bounds import Boxes, cross_surely, overlap
from surfmesh.intersection.cells import FaceCells, Numbered, Pairs
from surfmesh.intersection.newton import Pulled, pulled_onto_both, uv_directions
from surfmesh.intersection.regions import Region
from surfmesh.intersection.touching import Touch, touch_of_surfaces
from surfmesh.intersection.tracing import End, Trace, Tracer, place

SMALLEST = 1e-6
"""Of the diagonal: pairs of cells as small as that are not halved."""

LEVELS, MOST_PAIRS = 26, 6000
"""Halvings, and undecided pairs of one level, at most: more of them touch along a patch."""

BESIDE = 2e-3
"""Of the diagonal: so near to a branch point or a pole the surfaces meet in its curves alone."""

TRIED = 64
"""Undecided pairs that branch points are looked for from."""

AROUND = 0.1
"""Of a cell: how far outside it a point still answers for it."""

FIRST_STEP = 0.02
"""Of the smaller diagonal of both faces: the first step of a trace."""

TRACED = 1e-7
"""Of the diagonal: points so near to a traced branch are on it."""


class FacePair:
    """Two faces that may meet. size: of all that is intersected; gap: what is on both surfaces."""

    def __init__(
        self, a: CadFace, b: CadFace, cells: tuple[FaceCells, FaceCells],
        regions: tuple[Region, Region], size: float, gap: float,
    ) -> None:  # fmt: skip
        self.a, self.b = a.surface, b.surface
        self.cells_a, self.cells_b = cells
        self.region_a, self.region_b = regions
        self.size, self.gap = size, gap
        extent = min(_extent(cells[0]), _extent(cells[1]))
        self.tracer = Tracer(self.a, self.b, FIRST_STEP * extent, gap)
        self.traces: list[Trace] = []
        self.known: list[Trace] = []
        """Edges that both faces have, which are parts of their common curve."""
        self.is_one_surface = False
        self.singular: list[np.ndarray] = []
        """Points where normals do not tell how the surfaces meet: branch points, poles."""

    def all_branches(self, ends: Sequence[End]) -> list[Trace]:
        """Branches from all ``ends``, then closed ones. Raises ``SurfaceError``: see `Tracer`."""
        for start in ends:
            if start.used:
                continue
            start.used = True
            trace = self.tracer.trace(start, ends)
            assert trace.end is not None  # noqa: S101  an open one
            trace.end.used = True
            self.traces.append(trace)
        self._find_closed()
        return self.traces

    def branch_points(self) -> list[Touch]:
        """Points in the inside of both faces in which the surfaces have one tangent plane.

        Raises ``SurfaceError`` where they touch along a curve or a patch.
        """
        pairs = self._undecided(lambda pairs: np.ones(len(pairs), bool))
        if not len(pairs):
            return []
        middle = pairs.middles
        points = self.a.evaluate(middle[:, :2], 0)[0]
        found: list[Touch] = []
        rows = np.unique(np.linspace(0, len(pairs) - 1, min(len(pairs), TRIED)).astype(int))
        for k in rows:
            if any(np.linalg.norm(t.point - points[k]) <= BESIDE * self.size for t in found):
                continue
            touch = touch_of_surfaces(self.a, self.b, middle[k])
            apart = [np.linalg.norm(t.point - touch.point) for t in found]
            if touch.found and touch.gap <= 10.0 * self.gap:
                if all(distance > TRACED * self.size for distance in apart):
                    found.append(touch)
        far = np.ones(len(pairs), bool)
        for point in [*(touch.point for touch in found), *self.singular]:
            far &= np.linalg.norm(points - point, axis=1) > BESIDE * self.size
        self._refuse(pairs.kept(far))
        return [touch for touch in found if self._is_in_both(touch)]

    def _is_in_both(self, touch: Touch) -> bool:
        uv_a, uv_b = touch.place[None, :2], touch.place[None, 2:]
        return bool(self.region_a.inside(uv_a)[0] and self.region_b.inside(uv_b)[0])

    def _find_closed(self) -> None:
        self._refuse(self._undecided(self._answered))

    def _undecided(self, answered: Callable[[Pairs], np.ndarray]) -> Pairs:
        """Pairs of cells that can be halved no more.

        answered: of pairs that cross in one curve at most, are they done with?
        """
        pairs = Pairs.of(self.cells_a, self.cells_b)
        for _ in range(LEVELS):
            one = Numbered(self.cells_a, pairs.a, pairs.level_a)
            other = Numbered(self.cells_b, pairs.b, pairs.level_b)
            meet = overlap(one.boxes, one.of, other.boxes, other.of, other.cones)
            rows = np.flatnonzero(meet)
            pairs, i, j = pairs.kept(rows), one.of[rows], other.of[rows]
            surely = np.flatnonzero(cross_surely(one.cones, i, other.cones, j))
            still = ~self._are_singular(one.boxes, i)
            if len(surely):
                still[surely] &= ~answered(pairs.kept(surely))
            pairs, rows = pairs.kept(still), rows[still]
            if not len(pairs):
                break
            sizes = one.size(rows), other.size(rows)
            if max(sizes) < SMALLEST * self.size or len(pairs) > MOST_PAIRS:
                break
            pairs = pairs.halved(*sizes)
        return pairs

    def _are_singular(self, boxes: Boxes, i: np.ndarray) -> np.ndarray:
        """Of cells, do they lie beside a branch point or a pole, where the curves are known?"""
        near = np.zeros(len(i), bool)
        for point in self.singular:
            reach = np.maximum(np.abs(boxes.low[i] - point), np.abs(boxes.high[i] - point))
            near |= np.linalg.norm(reach, axis=1) <= BESIDE * self.size
        return near

    def _refuse(self, pairs: Pairs) -> None:
        """Name the place of pairs that are neither apart nor cross."""
        if not len(pairs):
            return
        middle_a, middle_b = np.hsplit(pairs.middles, 2)
        inside = ~self.region_a.surely_outside(middle_a) & ~self.region_b.surely_outside(middle_b)
        if not inside.any():
            return
        points = self.a.evaluate(middle_a[inside], 0)[0]
        where = points[len(points) // 2]
        spread = float(np.linalg.norm(np.ptp(points, axis=0)))
        what = "at" if spread < 0.02 * self.size else "along a curve or patch through"
        raise SurfaceError(
            f"{self.a.name} and {self.b.name} touch {what} {place(where)}, or lie within "
            f"{SMALLEST * self.size:.2g} of each other there with one tangent plane: such contacts "
            "are not intersected; move or change one of them"
        )

    def _answered(self, pairs: Pairs) -> np.ndarray:
        """For each pair, does a branch pass through it, or nearly? New ones are traced."""
        low, high = pairs.corners
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        found = pulled_onto_both(self.a, self.b, middle[:, :2], middle[:, 2:], widths=half)
        there = np.flatnonzero(found.gap <= self.gap)
        place_ = np.hstack([found.uv_a, found.uv_b])[there]
        moved = self._moved_into(place_, middle[there], half[there])
        found = pulled_onto_both(self.a, self.b, moved[:, :2], moved[:, 2:], widths=half[there])
        off = np.abs(np.hstack([found.uv_a, found.uv_b]) - middle[there]) / half[there]
        fine = (found.gap <= self.gap) & (off <= 1.0 + 2.0 * AROUND).all(axis=1)
        near = np.zeros(len(pairs), bool)
        near[there[fine]] = True
        self._trace_new(found, np.flatnonzero(fine))
        return near

    def _moved_into(self, place: np.ndarray, middle: np.ndarray, half: np.ndarray) -> np.ndarray:
        """Places (n, 4) on both surfaces, moved along the curve into boxes, or as near as may be.

        half: (n, 4) of the sides of the boxes around middle.
        """
        tangent = self.tracer.tangent(place[:, :2], place[:, 2:])[0]
        rate = np.hstack([
            uv_directions(self.a, place[:, :2], tangent),
            uv_directions(self.b, place[:, 2:], tangent),
        ])  # fmt: skip
        # |place + s rate - middle| <= half (1 + AROUND), in each of the four: an interval of s
        rate = np.where(np.abs(rate) < 1e-300, 1e-300, rate)
        one = (middle - half * (1.0 + AROUND) - place) / rate
        other = (middle + half * (1.0 + AROUND) - place) / rate
        first = np.minimum(one, other).max(axis=1)
        last = np.maximum(one, other).min(axis=1)
        s = np.where((first <= 0.0) & (last >= 0.0), 0.0, 0.5 * (first + last))
        step = s[:, None] * rate
        return np.where((np.abs(step) <= 4.0 * half).all(axis=1)[:, None], place + step, place)

    def _trace_new(self, found: Pulled, rows: np.ndarray) -> None:
        """Trace the branches through points that lie in both faces and on none so far."""
        for trace in [*self.known, *self.traces]:
            rows = self._beside(trace, found, rows)
        rows = rows[
            self.region_a.surely_inside(found.uv_a[rows])
            & self.region_b.surely_inside(found.uv_b[rows])
        ]
        while len(rows):
            self._trace_closed(found.uv_a[rows[0]], found.uv_b[rows[0]], found.point[rows[0]])
            rows = self._beside(self.traces[-1], found, rows[1:])

    def _beside(self, trace: Trace, found: Pulled, rows: np.ndarray) -> np.ndarray:
        """Those rows of points that do not lie on a traced branch."""
        on = self.tracer.lie_on(trace, found.point[rows], TRACED * self.size)
        return rows[~on]

    def _trace_closed(self, uv_a: np.ndarray, uv_b: np.ndarray, point: np.ndarray) -> None:
        way = self.tracer.tangent(uv_a[None], uv_b[None])[0][0]
        start = End(-1, uv_a, uv_b, point, way)
        end = End(-1, uv_a, uv_b, point, -way)
        self.traces.append(self.tracer.trace(start, [end], closed=True))


def _extent(cells: FaceCells) -> float:
    line = np.linspace(0.0, 1.0, 9)
    uv = cells.low + np.stack(np.meshgrid(line, line), -1).reshape(-1, 2) * cells.width
    points = cells.surface.evaluate(uv, 0)[0]
    return float(np.linalg.norm(np.ptp(points, axis=0)))
