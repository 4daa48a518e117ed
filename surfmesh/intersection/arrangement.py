"""The curves on one face cut it into regions.

            a                    Half-edges: the coedges of the loops, inside on the left, and
      ------>------o  k          every curve both ways. Where several meet in a place k of (u, v),
      <-----       ^  |          a walk that comes in by h goes on by the first half-edge
         h     next|  v          clockwise from where it came: it keeps to its region's border.

Walks that turn counter-clockwise are outer loops, the others holes in the smallest outer loop
around them; a curve that ends inside is walked there and back.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadFace
from surfmesh.errors import SurfaceError
from surfmesh.geometry.rings import ring_area
from surfmesh.geometry.small_matrices import norm
from surfmesh.intersection.regions import polygon_of
from surfmesh.intersection.tracing import place

PARALLEL = 1e-6
"""Radians: half-edges that leave one place nearer to each other than that cannot be told apart."""

BESIDE = 0.05
"""Of the shortest of them: where half-edges with one tangent are told apart."""

FLAT = 1e-12
"""Of the square of its box: a walk that encloses less goes there and back."""

MIDDLE = np.array([0.5])
SAME = 1e-9
"""In (u, v): two uses of an edge whose middles are so near are one curve."""

Loop = tuple[CadCoedge, ...]


@dataclass(frozen=True, eq=False)
class HalfEdge:
    """A coedge between two places. start, end: keys of these. leaves, enters: (2,) directions in
    (u, v), scaled to lengths: as it leaves its start, and as it comes to its end."""

    coedge: CadCoedge
    start: object
    end: object
    leaves: np.ndarray
    enters: np.ndarray
    scale: np.ndarray

    @cached_property
    def length(self) -> float:
        """About how far its middle is from its ends."""
        first, middle, last = self.coedge.walk(np.array([0.0, 0.5, 1.0])) * self.scale
        return float(min(norm(middle - first), norm(last - middle)))

    def ahead(self, off: float) -> np.ndarray:
        """The direction in which it leaves its start, or the chord to the place so far off."""
        return self._chord(off, False) if off > 0.0 else self.leaves

    def back(self, off: float) -> np.ndarray:
        """The direction back from its end, or the chord to the place so far off."""
        return self._chord(off, True) if off > 0.0 else -self.enters

    def _chord(self, off: float, backwards: bool) -> np.ndarray:
        low, high = 0.0, 0.5
        for _ in range(60):
            middle = 0.5 * (low + high)
            at = np.array([1.0, 1.0 - middle] if backwards else [0.0, middle])
            start, place_ = self.coedge.walk(at) * self.scale
            low, high = (low, middle) if norm(place_ - start) > off else (middle, high)
        return place_ - start


def half_edge(coedge: CadCoedge, start: object, end: object, scale: np.ndarray) -> HalfEdge:
    """scale: (2,) lengths in space of a unit of u and of v, on average."""
    rates = coedge.pcurve.evaluate(np.array([coedge.p0, coedge.p1]), 1)[1]
    rates = rates * (coedge.p1 - coedge.p0)
    if coedge.reversed:
        rates = -rates[::-1]
    return HalfEdge(coedge, start, end, rates[0] * scale, rates[1] * scale, scale)


def turn(first: np.ndarray, second: np.ndarray) -> float:
    """Counter-clockwise angle from one direction to another, 0 to 2 pi."""
    angle = math.atan2(second[1], second[0]) - math.atan2(first[1], first[0])
    return angle % (2.0 * math.pi)


def regions(face: CadFace, halves: Sequence[HalfEdge]) -> list[tuple[Loop, ...]]:
    """The loops of each region, the outer one first. Raises ``SurfaceError``."""
    walks = _walks(face, halves)
    scale = np.ptp(np.array(face.surface.domain), axis=1)
    rings = [_ring(walk, scale) for walk in walks]
    areas = np.array([ring_area(ring) for ring in rings])
    size = np.array([float(np.prod(np.ptp(ring, axis=0)) + 1e-300) for ring in rings])
    outer = np.flatnonzero(areas > FLAT * size)
    outer = outer[~np.array([_is_slit(walks[k]) for k in outer], bool)]
    if not len(outer):
        raise SurfaceError(f"{face.surface.name}: its curves enclose nothing")
    held: dict[int, list[Loop]] = {int(k): [walks[k]] for k in outer}
    for k in range(len(walks)):
        if k in held:
            continue
        own = {coedge.edge for coedge in walks[k]}
        around = [
            o for o in outer
            if own.isdisjoint(coedge.edge for coedge in walks[o]) and _is_in(rings[k], rings[o])
        ]  # fmt: skip
        if not around:
            middle = face.surface.evaluate((rings[k][:1]) * scale, 0)[0][0]
            raise SurfaceError(
                f"{face.surface.name}: a loop of curves through {place(middle)} lies in no region"
            )
        held[int(min(around, key=lambda o: areas[o]))].append(walks[k])
    return [tuple(loops) for loops in held.values()]


def _walks(face: CadFace, halves: Sequence[HalfEdge]) -> list[Loop]:
    leaving: dict[object, list[int]] = {}
    for number, half in enumerate(halves):
        leaving.setdefault(half.start, []).append(number)
    used = [False] * len(halves)
    walks = []
    for first in range(len(halves)):
        if used[first]:
            continue
        walk, number = [], first
        while not used[number]:
            used[number] = True
            walk.append(halves[number].coedge)
            number = _next(face, halves, halves[number], leaving)
        if number != first:
            raise SurfaceError(f"{face.surface.name}: curves on it do not close to regions")
        walks.append(tuple(walk))
    return walks


def _next(
    face: CadFace, halves: Sequence[HalfEdge], half: HalfEdge, leaving: dict[object, list[int]]
) -> int:
    ways = leaving.get(half.end, [])
    if len(ways) == 1:
        return ways[0]
    if not ways:
        raise SurfaceError(f"{face.surface.name}: a curve on it ends at no other")
    # clockwise from the way back; the twin itself last
    turns = _turns(half, [halves[k] for k in ways], 0.0)
    if _are_close(turns):  # they leave with one tangent: by where they are a little further on
        shortest = min(halves[k].length for k in ways)
        turns = _turns(half, [halves[k] for k in ways], BESIDE * min(shortest, half.length))
    order = np.argsort(turns)
    if _are_close(turns):
        where = half.coedge.walk(np.array([1.0]))
        raise SurfaceError(
            f"{face.surface.name}: curves on it touch at "
            f"{place(face.surface.evaluate(where, 0)[0][0])}; move one of the surfaces"
        )
    return ways[int(order[0])]


def _turns(half: HalfEdge, ways: Sequence[HalfEdge], off: float) -> np.ndarray:
    """Clockwise angles from the way back to each way that leaves the end of a half-edge: of the
    tangents, or of the chords to places so far off. The twin itself is a whole turn off."""
    back = half.back(off)
    turns = np.array([turn(way.ahead(off), back) for way in ways])
    for k, way in enumerate(ways):
        if way.coedge.edge == half.coedge.edge and way.coedge.reversed != half.coedge.reversed:
            if min(turns[k], 2.0 * math.pi - turns[k]) < PARALLEL:
                turns[k] = 2.0 * math.pi
    return turns


def _are_close(turns: np.ndarray) -> bool:
    """Can the first one not be told from the next, or from the way back?"""
    order = np.sort(turns)
    return bool(order[0] < PARALLEL or (len(order) > 1 and order[1] - order[0] < PARALLEL))


def _ring(walk: Loop, scale: np.ndarray) -> np.ndarray:
    return np.concatenate([polygon_of(coedge, scale)[0][:-1] for coedge in walk])


def _is_slit(walk: Loop) -> bool:
    """Does it run along each curve of (u, v) there and back? A seam's two sides are two."""
    uses: dict[int, list[CadCoedge]] = {}
    for coedge in walk:
        uses.setdefault(coedge.edge, []).append(coedge)
    return all(
        len(own) == 2
        and own[0].reversed != own[1].reversed
        and np.allclose(own[0].uv(MIDDLE), own[1].uv(MIDDLE), rtol=0.0, atol=SAME)
        for own in uses.values()
    )


def _is_in(inner: np.ndarray, outer: np.ndarray) -> bool:
    """Is the most of a ring's points within another? They do not cross, but may touch."""
    a, b = outer, np.roll(outer, -1, axis=0)
    steps = inner[:: max(1, len(inner) // 33)]
    middles = 0.5 * (steps + np.roll(steps, -1, axis=0)) if len(steps) < 3 else steps
    u, v = middles.T[..., None]
    rise = np.where(b[:, 1] == a[:, 1], 1.0, b[:, 1] - a[:, 1])
    spans = (a[:, 1] > v) != (b[:, 1] > v)
    crossing = a[:, 0] + (v - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
    inside = (spans & (crossing < u)).sum(axis=1) % 2 == 1
    return bool(inside.mean() > 0.5)
