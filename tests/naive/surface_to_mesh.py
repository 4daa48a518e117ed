"""How far the true surface lies from the mesh, step by step in numpy.

    rim of the surface        .--x--.            x: points of the surface that are looked at,
                            o---------o          on free rims and over every triangle; there
    mesh                   / \\   x   / \\         ``deviation`` looks from o, mesh to surface

Points are r(u, v) within the triangles' own (u, v), so on the surface whatever its shape. The
distance to the own triangle bounds that to the mesh from above; where it might decide, the
nearest triangle is searched for: among neighbours as long as a nearer one is found, for the
farthest few among all. Between the points nothing is bounded.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import TriangleStars, segment_samples
from surfmesh._core.quality import largest_values as largest
from surfmesh.quality.measures.deviation import Deviation
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.places import as_point, as_uv
from surfmesh.quality.measures.surface_to_mesh import (
    FacesWithCurves,
    SegmentCurves,
    SurfaceDeviation,
)
from surfmesh.quality.measures.tolerances import CHORD_SLACK, Tolerances
from surfmesh.result.surface_mesh import SurfaceMesh

BLOCK = 1 << 15  # samples looked at together: the temporaries stay within the cache
ALONG_RIM = np.arange(1, 8) / 8.0  # along each free edge
MIDDLE = np.array([0.5])
# of an arc of an ellipse: what is farthest from its chord at the others of these, over the middle.
# With c(t) = cos(t) U + sin(t) V about the middle they are (cos t - cos a) |U| from it at most
BESIDE_MIDDLE = float(1.0 - np.min(np.abs(1.0 - 2.0 * ALONG_RIM[ALONG_RIM != MIDDLE])) ** 2)
WITHIN = np.array([(4, 1, 1), (1, 4, 1), (1, 1, 4)]) / 6.0  # barycentric, over every triangle
_GRID = 6
CLOSELY = np.array(
    [(i, j, _GRID - i - j) for i in range(_GRID + 1) for j in range(_GRID + 1 - i)]
) / float(_GRID)  # over the worst of them, as ``deviation`` does
SECOND_LOOK = 400  # triangles looked at closely, or one in 250 if that is more
ON_CURVE = 1e-3  # of a segment: so far off the curve of its edge may its nodes be
FIRST_FEW = 64  # points whose nearest triangle is searched for at first
MOST_COMPARED = 2_000  # points beyond the chord that are compared with every triangle
AMONG_ALL = 16  # points that are compared with every triangle in the end, at most


def surface_deviation(
    known: KnownSurfaces, fit: Deviation, tolerances: Tolerances
) -> SurfaceDeviation | None:
    """Distance of the surfaces from the mesh; None where ``fit``, the way back, is not finite."""
    if not np.isfinite(fit.largest):
        return None
    mesh = known.mesh
    search = _Search(known, fit, tolerances)
    count = len(mesh.triangles)
    curved = np.flatnonzero(known.in_plane == 0).astype(np.int32)  # elsewhere corners say all
    search.look_over(curved, WITHIN)
    # after these, which tell what is not worth a search along flat faces
    if search.curves is not None:
        _look_along_curves(search, search.curves, fit)
    else:
        search.look(*_on_rims(mesh), at_rim=True)
    worth = np.maximum(fit.by_triangle, search.by_triangle)
    chosen = min(count, max(SECOND_LOOK, count // 250))
    worst = largest(worth, chosen)
    search.look(*_over(worst[known.in_plane[worst] == 0], CLOSELY))
    return search.result()


Rule = tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float64]]


def _over(triangles: NDArray[np.int32], weights: NDArray[np.float64]) -> Rule:
    """Triangles (k,) of points over each of them, the row (k,) of ``weights`` for each, weights."""
    rule = np.tile(np.arange(len(weights), dtype=np.int32), len(triangles))
    return np.repeat(triangles, len(weights)), rule, weights


def _on_rims(mesh: SurfaceMesh) -> Rule:
    """The same along all edges of one triangle only."""
    half_edge = mesh.connectivity.half_edges[mesh.connectivity.uses == 1, 0]
    triangle, side = np.divmod(np.repeat(half_edge, len(ALONG_RIM)), 3)
    t = np.tile(ALONG_RIM, len(half_edge))
    weights, rows = np.zeros((len(triangle), 3)), np.arange(len(triangle), dtype=np.int32)
    weights[rows, side], weights[rows, (side + 1) % 3] = 1.0 - t, t
    return triangle, rows, weights


class Curves(SegmentCurves):
    """Points of the curves between the ends of segments."""

    def between(
        self, segments: NDArray[np.intp], t: NDArray[np.float64], nodes: NDArray[np.float64]
    ) -> tuple[NDArray[np.intp], NDArray[np.float64], NDArray[np.float64]]:
        """Those of segments (k,) that may lie off their curves, and points (g j, 3) of these at
        ``t`` (j,); nodes: (n, 3) of the mesh. And how far (g,) the nodes of arcs of ellipses are
        from these; infinite for others."""
        if not len(segments):
            return segments, np.empty((0, 3)), np.empty(0)
        numbers = self.ids[segments]
        there = segments[(numbers >= 0) & (numbers < len(self.edges))]
        found, points, off_arc = segment_samples(
            self.core_curves, self.limits, self.ids[there], self.ends[there],
            self.segments[there], nodes, t, ON_CURVE,
        )  # fmt: skip
        return there[found], points, off_arc


def _look_along_curves(search: _Search, curves: Curves, fit: Deviation) -> None:
    """At points of the CAD edges between the nodes of their segments.

    They count for that one of two faces which is farther from the mesh itself: the round one.
    The middle of each is looked at first: of an arc of an ellipse that settles the others, where
    it is as far from the triangle as they may be from the segment, a side of the triangle.
    Where nodes lie off their curve, as after ``simplify``, what is between says nothing.
    """
    known = search.known
    mesh = known.mesh
    rows = mesh.edge_segment_rows
    first, second = mesh.connectivity.half_edges[np.maximum(rows, 0)].T // 3
    free = second < 0
    farther = ~free & (fit.by_triangle[second] > fit.by_triangle[first])
    over = np.where(farther, second, first)
    segments, middles, off_arc = curves.between(np.flatnonzero(rows >= 0), MIDDLE, mesh.points)
    ends = mesh.points[curves.segments[segments]]
    height = np.linalg.norm(middles - (ends[:, 0] + ends[:, 1]) / 2.0, axis=1)
    beside = BESIDE_MIDDLE * (height + off_arc) + off_arc
    open_ones = [np.empty(0, np.intp)]
    for at_rim in (True, False):
        some = np.flatnonzero(free[segments] == at_rim)
        for block in _blocks(some, BLOCK):
            seen = search.look_at(middles[block], over[segments[block]], at_rim)
            open_ones.append(segments[block[~(seen >= beside[block])]])
    _look_between(search, curves, np.concatenate(open_ones), over, free)


def _look_between(
    search: _Search, curves: Curves, segments: NDArray[np.intp], over: NDArray, free: NDArray
) -> None:
    """At all points of some segments, over triangles of these; free: those at rims."""
    looked_at, between, _ = curves.between(np.sort(segments), ALONG_RIM, search.mesh.points)
    between = between.reshape(-1, len(ALONG_RIM), 3)
    for at_rim in (True, False):
        some = np.flatnonzero(free[looked_at] == at_rim)
        for block in _blocks(some, BLOCK // len(ALONG_RIM)):
            triangle = np.repeat(over[looked_at[block]], len(ALONG_RIM))
            search.look_at(between[block].reshape(-1, 3), triangle, at_rim)


def _blocks(members: NDArray, length: int) -> Iterator[NDArray]:
    for start in range(0, len(members), length):
        yield members[start : start + length]


class _Candidate(NamedTuple):
    """A point that may be the farthest."""

    distance: float
    point: NDArray[np.float64]
    uv: NDArray[np.float64]
    triangle: int
    at_rim: bool


@dataclass(frozen=True)
class _Samples:
    """Points of the surface."""

    triangle: NDArray[np.int32]  # (k,) that each is over
    distance: NDArray[np.float64]  # (k,) from it; lowered where another triangle is nearer
    points: NDArray[np.float64]  # (k, 3)
    uv: NDArray[np.float64]  # (k, 2)

    def places(self, rows: NDArray[np.intp]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Points (n, 3) and parameters (n, 2) of some of them."""
        return self.points[rows], self.uv[rows]

    def raise_to_largest(self, by_triangle: NDArray[np.float64]) -> None:
        """Raise distances (m,) of all triangles to those of the samples."""
        np.maximum.at(by_triangle, self.triangle, self.distance)


@dataclass(frozen=True)
class _SamplesAtWeights:
    """The same, each point made where it is asked for."""

    triangle: NDArray[np.int32]
    distance: NDArray[np.float64]
    known: KnownSurfaces
    rule: NDArray[np.int32]  # (k,)
    weights: NDArray[np.float64]  # barycentric, those of ``rule`` for each

    def places(self, rows: NDArray[np.intp]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Points (n, 3) and parameters (n, 2) of some of them."""
        uv, points, _ = self.known.sampled(self.triangle[rows], self.rule[rows], self.weights)
        return points, uv

    def raise_to_largest(self, by_triangle: NDArray[np.float64]) -> None:
        """Raise distances (m,) of all triangles to those of the samples, which follow each other
        triangle by triangle."""
        each = len(self.weights)
        over = self.triangle[::each]
        found = by_triangle[over]
        for column in self.distance.reshape(-1, each).T:
            np.maximum(found, column, out=found)
        by_triangle[over] = found


class _Search:
    """The distances over each triangle, and the points that are farthest."""

    def __init__(self, known: KnownSurfaces, fit: Deviation, tolerances: Tolerances) -> None:
        self.known, self.mesh = known, known.mesh
        self.curves = Curves.of(known.mesh)
        self.faces = FacesWithCurves(known, self.curves)
        mesh = known.mesh
        chord = tolerances.at(tolerances.chord, mesh.face_ids) * (1.0 + CHORD_SLACK)
        # a triangle that is too far from the surface itself needs no second proof
        self.far = fit.by_triangle > chord
        self.enough = np.where(self.far, np.inf, chord)
        self.back = fit.largest
        self.by_triangle = np.zeros(len(mesh.triangles))
        self.largest = 0.0
        self.found: list[_Candidate] = []

    def look(
        self, triangle: NDArray, rule: NDArray, weights: NDArray, at_rim: bool = False
    ) -> None:
        """At points over triangles (k,), at the barycentric ``weights[rule]``."""
        if not len(triangle):
            return
        uv, points, distance = self.known.sampled(triangle, rule, weights)
        self._take(_Samples(triangle, distance, points, uv), at_rim)

    def look_over(self, triangles: NDArray[np.int32], weights: NDArray) -> None:
        """At points over triangles (k,), at the same barycentric weights (w, 3) of each."""
        distance = self.known.surface_distances(triangles, weights)
        for rows in _blocks(np.arange(len(triangles)), BLOCK // len(weights)):
            own = distance[len(weights) * rows[0] : len(weights) * (rows[-1] + 1)]
            triangle, rule, _ = _over(triangles[rows], weights)
            self._take(_SamplesAtWeights(triangle, own, self.known, rule, weights), at_rim=False)

    def look_at(self, points: NDArray, triangle: NDArray, at_rim: bool) -> NDArray[np.float64]:
        """At points (k, 3) of the surface over triangles (k,). Returns the distances (k,) from
        these that stand: -1 where one may be the largest, or beyond the chord, or is lowered."""
        if not len(triangle):
            return np.empty(0)
        distance = self._stars.distances(points, triangle)
        uv = self.known.middle_uv(triangle)  # about there
        own = distance.copy()
        self._take(_Samples(triangle, distance, points, uv), at_rim)
        stands = (own == distance) & (own <= self.largest) & (own <= self.enough[triangle])
        return np.where(stands, own, -1.0)

    def _take(self, samples: _Samples | _SamplesAtWeights, at_rim: bool) -> None:
        """What samples say of the triangles that they are over."""
        triangle, distance = samples.triangle, samples.distance
        distance[~np.isfinite(distance)] = 0.0  # where a formula has no value
        known = self._refine(samples)
        samples.raise_to_largest(self.by_triangle)
        known = known[np.argsort(-distance[known], kind="stable")[:AMONG_ALL]]
        points, uv = samples.places(known)
        self.found += [
            _Candidate(float(distance[k]), points[row], uv[row], int(triangle[k]), at_rim)
            for row, k in enumerate(known.tolist())
        ]

    def _refine(self, samples: _Samples | _SamplesAtWeights) -> NDArray:
        """Lower the distances, of the own triangles, to those of the nearest ones: where they are
        beyond the chord, and where one of them may be the largest. Returns which."""
        triangle, distance = samples.triangle, samples.distance
        done, length = np.zeros(len(distance), bool), FIRST_FEW
        beyond = np.flatnonzero(distance > self.enough[triangle])
        while True:
            some = np.flatnonzero(distance > self.largest)
            some = some[~done[some]]
            if len(some) > length:
                most = len(some) - length
                some = np.sort(some[np.argpartition(distance[some], most)[most:]])
            if len(beyond):  # all of them at once
                some = np.union1d(some, beyond)
                beyond = beyond[:0]
            if not len(some):
                return np.flatnonzero(done)
            points, uv = samples.places(some)
            distance[some] = self._nearest(points, uv, triangle[some], distance[some])
            done[some] = True
            self.largest = max(self.largest, float(distance[some].max()))
            length *= 4

    def _nearest(
        self, points: NDArray, uv: NDArray, triangle: NDArray, distance: NDArray
    ) -> NDArray:
        """Distances (k,) to nearer triangles, from neighbour to neighbour while there are such."""
        distance = self._stars.walk(points, triangle, distance)
        self._compare_beyond(points, uv, triangle, distance)
        return distance

    def _compare_beyond(
        self, points: NDArray, uv: NDArray, triangle: NDArray, distance: NDArray
    ) -> None:
        """Lower, in place, what is still beyond the chord: the way from neighbour to neighbour
        ends early where triangles are long and thin. Given up where nothing is lowered: the
        mesh is too far, then."""
        beyond = np.flatnonzero(distance > self.enough[triangle])
        lowered = 0
        for count, k in enumerate(beyond[np.argsort(-distance[beyond], kind="stable")].tolist()):
            if count >= MOST_COMPARED or (count >= AMONG_ALL and not lowered):
                break
            exact = self._among_all(points[k], float(distance[k]))
            if exact > self.enough[triangle[k]] and self.faces.are_left(uv[k], int(triangle[k])):
                exact = 0.0
            lowered += exact < distance[k]
            distance[k] = exact

    @cached_property
    def _stars(self) -> TriangleStars:
        return TriangleStars(self.mesh.points, self.mesh.triangles)

    def result(self) -> SurfaceDeviation:
        """What is found; the farthest points, if they are farther than any of the mesh from the
        surface, are compared with all triangles first: another part may be nearer."""
        self.found.sort(key=lambda found: -found.distance)
        best: _Candidate | None = None
        for number, found in enumerate(self.found):
            if best is not None and (found.distance <= best.distance or number >= AMONG_ALL):
                break
            exact = found.distance
            if exact > self.back:
                exact = self._among_all(found.point, exact)
            if exact < found.distance == self.by_triangle[found.triangle]:
                self.by_triangle[found.triangle] = exact
            if best is None or exact > best.distance:
                best = found._replace(distance=exact)
        if best is None:  # all that was looked at lies on the mesh to the last bit
            first = np.zeros(1, np.int32)
            corner, uv = self.known.points(first)[0, 0], self.known.uv(first)[0, 0]
            best = _Candidate(0.0, corner, uv, 0, False)
        self.by_triangle[self.far] = 0.0
        return SurfaceDeviation(
            self.by_triangle, best.distance, as_point(best.point), as_uv(best.uv), best.triangle,
            best.at_rim,
        )  # fmt: skip

    def _among_all(self, point: NDArray, distance: float) -> float:
        """Of a point (3,) from the whole mesh, known to be no more than ``distance``."""
        return self._stars.distance_from_all(tuple(point.tolist()), distance)
