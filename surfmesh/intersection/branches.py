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

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from surfmesh.cad.model.cad_model import CadFace
from surfmesh.errors import SurfaceError
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.small_matrices import norm
from surfmesh.intersection.bounds import Boxes, cross_surely, overlap
from surfmesh.intersection.cells import FaceCells, Numbered, Pairs
from surfmesh.intersection.contact_curves import ContactTracer, pulled_into_contact, touches_there
from surfmesh.intersection.newton import Pulled, pulled_onto_both, uv_directions
from surfmesh.intersection.regions import Region
from surfmesh.intersection.touching import branch_ways
from surfmesh.intersection.tracing import End, Trace, Tracer, place

SMALLEST = 1e-6
"""Of the diagonal: pairs of cells as small as that are not halved."""

LEVELS, MOST_PAIRS = 26, 6000
"""Halvings, and undecided pairs of one level, at most: more of them touch along a patch."""

BESIDE = 2e-3
"""Of the diagonal: so near to a branch point or a pole the surfaces meet in its curves alone."""

NEAR_CONTACT = 0.01
"""Of the diagonal: so near to a curve along which they touch the surfaces meet in it alone."""

BESIDE_CONTACTS = 8
"""Times MOST_PAIRS, where such curves are known: their cells are small before they are done."""

MOST_TANGENCIES = 40
"""Rounds in which tangencies are looked for."""

RING = 1e-3
"""Of the (u, v) box: so far around a place surfaces coincide that are one."""

SAME = 1e-8
"""Of the diagonal: surfaces so near to each other coincide."""

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
        self.contact_tracer = ContactTracer(self.a, self.b, FIRST_STEP * extent, 10.0 * gap)
        self.traces: list[Trace] = []
        self.known: list[Trace] = []
        """Edges that both faces have, which are parts of their common curve."""
        self.is_one_surface = False
        self.singular: list[np.ndarray] = []
        """Points where normals do not tell how the surfaces meet: branch points, poles."""

    def all_branches(self, ends: Sequence[End]) -> list[Trace]:
        """Branches from all ``ends``, then closed ones. Raises ``SurfaceError``: see `Tracer`."""
        for start in ends:
            if start.used or start.touches:
                continue
            start.used = True
            trace = self.tracer.trace(start, [end for end in ends if not end.touches])
            assert trace.end is not None  # noqa: S101  an open one
            trace.end.used = True
            self.traces.append(trace)
        self._find_closed()
        return self.traces

    def contacts_from(self, ends: Sequence[End]) -> Iterator[Trace]:
        """Curves along which the surfaces touch, from those of the ends where one starts."""
        touching = [end for end in ends if end.touches]
        for start in touching:
            if not start.used:
                start.used = True
                trace = self.contact_tracer.trace(start, touching)
                assert trace.end is not None  # noqa: S101  an open one
                trace.end.used = True
                yield trace

    def closed_contact(self, found: Pulled) -> Trace:
        """The closed curve through a place along which the surfaces touch."""
        way = branch_ways(self.a, self.b, found.uv_a, found.uv_b)[1][0]
        start = End(-1, found.uv_a, found.uv_b, found.point, way, touches=True)
        end = End(-1, found.uv_a, found.uv_b, found.point, -way, touches=True)
        return self.contact_tracer.trace(start, [end], closed=True)

    def tangencies(self) -> Iterator[tuple[str, Pulled]]:
        """Places, in the inside of both faces or beside their borders, where the surfaces have one
        tangent plane: "cross", "touch" in a point, "along" a curve.

        What is found is done with once it is in ``singular`` or among ``known``; where both are
        ``is_one_surface`` nothing more is said. Raises ``SurfaceError`` where surfaces come near
        each other without any of these.
        """
        for _ in range(MOST_TANGENCIES):
            pairs = self._undecided(lambda pairs: np.ones(len(pairs), bool))
            if not len(pairs):
                return
            said = False
            for what, found in self._explained(pairs):
                said = True
                if what == "flat":
                    self.is_one_surface = True
                    return
                yield what, found
            if not said:
                self._refuse(pairs)
                return

    def _explained(self, pairs: Pairs) -> Iterator[tuple[str, Pulled]]:
        """The tangencies that undecided pairs lead to, each kind of place once."""
        middle = pairs.middles
        rows = np.unique(np.linspace(0, len(pairs) - 1, min(len(pairs), TRIED)).astype(int))
        found = pulled_into_contact(self.a, self.b, middle[rows, :2], middle[rows, 2:])
        fine = touches_there(self.a, self.b, found, 10.0 * self.gap)
        seen: list[np.ndarray] = []
        for k in np.flatnonzero(fine):
            one = Pulled(*(column[k] for column in found))
            done = [norm(point - one.point) for point in [*seen, *self.singular]]
            if any(distance <= TRACED * self.size for distance in done):
                continue
            if self._is_beside_contact(one.point[None], 0.5 * NEAR_CONTACT * self.size)[0]:
                continue
            what, _ = branch_ways(self.a, self.b, one.uv_a, one.uv_b)
            if what == "flat" and not self._is_one_around(one):
                continue
            if what == "along" and not self._are_surely_in_both(one):
                continue
            seen.append(one.point)
            yield what, one
            if what in ("along", "flat"):
                return

    def _is_one_around(self, found: Pulled) -> bool:
        """Do the surfaces coincide around a place?"""
        angle = np.arange(8) * (0.25 * np.pi)
        ring = np.column_stack([np.cos(angle), np.sin(angle)])
        uv = found.uv_a + RING * self.cells_a.width * ring
        points = self.a.evaluate(uv, 0)[0]
        guess = np.repeat(found.uv_b[None], len(uv), axis=0)
        distance = closest_point(self.b, points, guess, 12, 0.0)[1]
        return bool((distance <= SAME * self.size).all())

    def _is_beside_contact(self, points: np.ndarray, reach: float) -> np.ndarray:
        """Of points (n, 3), do they lie so near to a curve along which the surfaces touch?"""
        near = np.zeros(len(points), bool)
        for trace in self.known:
            if trace.touches:
                for k in range(0, len(points), 4096):  # not all distances at a time
                    step = points[k : k + 4096, None] - trace.points
                    near[k : k + 4096] |= np.einsum("nmi,nmi->nm", step, step).min(1) <= reach**2
        return near

    def are_in_both(self, found: Pulled) -> bool:
        """Does one place lie within both faces?"""
        uv_a, uv_b = found.uv_a[None], found.uv_b[None]
        return bool(self.region_a.inside(uv_a)[0] and self.region_b.inside(uv_b)[0])

    def _are_surely_in_both(self, found: Pulled) -> bool:
        uv_a, uv_b = found.uv_a[None], found.uv_b[None]
        inside = self.region_a.surely_inside(uv_a) & self.region_b.surely_inside(uv_b)
        return bool(inside[0])

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
            most = BESIDE_CONTACTS * MOST_PAIRS if self._touches else MOST_PAIRS
            if max(sizes) < SMALLEST * self.size or len(pairs) > most:
                break
            pairs = pairs.halved(*sizes)
        return pairs

    def _are_singular(self, boxes: Boxes, i: np.ndarray) -> np.ndarray:
        """Of cells, do they lie beside a branch point or a pole, where the curves are known?"""
        near = np.zeros(len(i), bool)
        for point in self.singular:
            reach = np.maximum(np.abs(boxes.low[i] - point), np.abs(boxes.high[i] - point))
            near |= np.linalg.norm(reach, axis=1) <= BESIDE * self.size
        if self._touches:
            low, high = boxes.low, boxes.high
            room = 0.5 * np.linalg.norm(high - low, axis=1)
            reach = NEAR_CONTACT * self.size
            small = np.flatnonzero(room <= 0.5 * reach)
            beside = np.zeros(len(low), bool)
            middles = 0.5 * (low[small] + high[small])
            beside[small] = self._is_beside_contact(middles, 0.5 * reach)
            near |= beside[i]
        return near

    @property
    def _touches(self) -> bool:
        return any(trace.touches for trace in self.known)

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
        spread = norm(np.ptp(points, axis=0))
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
    return norm(np.ptp(points, axis=0))
