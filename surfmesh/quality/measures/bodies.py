"""Bodies of a model that overlap, and those that touch without a common face.

    pairs of triangles that meet -> of one body, or of two: how deep do they go?
                                    deeper than their facets may     -> overlap, or cross
                                    not: how deep do corners of one lie within the true other?
                                    at all                           -> overlap
                                    not at all                       -> touch, or lie near
    solids that do not cross     -> points just within the faces of one: do they lie in the
                                    other too (nested, or twice the same)? Just outside: touch

A body is a solid, or a piece of faces of no solid that hang together. A piece has no inside: it
can cross, not overlap.
"""

from collections.abc import Set
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import solid_boxes
from surfmesh._core.space import triangle_distances
from surfmesh.geometry.boxes import diagonal
from surfmesh.quality.measures.by_solid import SolidRow
from surfmesh.quality.measures.inside import inside
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.overlap_depth import overlap_depth
from surfmesh.quality.measures.penetration import depths, distances_allowed
from surfmesh.quality.measures.places import Point, as_point
from surfmesh.quality.measures.solids import solids_beside
from surfmesh.quality.measures.topology import vertex_components
from surfmesh.quality.measures.true_depth import true_depth, true_depth_of_faces
from surfmesh.result.surface_mesh import SurfaceMesh

SAME = 1e-6  # of the diagonal: what lies nearer together is in one place
FACETS = 2.0  # depths up to so many times the distances of both from their surfaces are contact
PROBES = 6  # triangles of a face beside which points are looked at
CLEAR = 0.5  # of the depth of such a point: no nearer than this to either body's surface
OVERLAP, TOUCH, NEAR = "overlap", "touch", "near"
BLOCK = 20_000  # pairs of triangles looked at together


@dataclass(frozen=True)
class BodyPair:
    """Two bodies that overlap or touch."""

    names: tuple[str, str]
    solids: tuple[int, int]  # their numbers; -1: faces of no solid
    kind: str  # "overlap", "touch", or "near": their facets meet, their faces do not
    triangles: int  # pairs of them that meet
    depth: float | None  # by which they overlap at least, or their facets; None: one lies within
    gap: float | None  # between faces that are near
    point: Point


class Bodies(NamedTuple):
    """What became of the pairs of triangles that meet, and the bodies concerned."""

    own: NDArray[np.bool_]  # (k,) of the pairs of triangles: a body meets itself, sheets cross
    contacts: int  # pairs of triangles between bodies that only touch, or are near
    overlapping: tuple[BodyPair, ...]
    touching: tuple[BodyPair, ...]
    near: tuple[BodyPair, ...]


def bodies(
    mesh: SurfaceMesh,
    pairs: NDArray[np.int32],
    solids: tuple[SolidRow, ...],
    by_triangle: NDArray[np.float64] | None,
    edge_to_edge: Set[tuple[int, int]] = frozenset(),
) -> Bodies:
    """pairs: (k, 2) triangles that meet; by_triangle: (m,) distances from the surface;
    edge_to_edge: pairs of faces, or of a face with itself, whose rims lie along each other: so
    they meet, and no more.
    """
    own = np.ones(len(pairs), bool)
    if mesh.solid_ids is None:
        return Bodies(own, 0, (), (), ())
    table = mesh.solid_ids
    count = int(table.max(initial=-1)) + 1
    if not len(pairs) and count < 2:
        return Bodies(own, 0, (), (), ())
    least = SAME * diagonal(mesh.points)
    closed = _Solids(mesh, [row.solid for row in solids if row.closed])
    if not len(pairs) and closed.are_apart(least):
        return Bodies(own, 0, (), (), ())
    allowed = FACETS * distances_allowed(mesh, by_triangle)
    between = np.flatnonzero(_apart(mesh, pairs) | _beside_rims(mesh, pairs, edge_to_edge))
    of_triangle = _body_numbers(mesh, count)
    deep = np.zeros(len(between), bool)
    depth = _depths(mesh, pairs[between])
    limit = allowed[pairs[between]].sum(axis=1) + least
    numbers = of_triangle[pairs[between]]
    keys = np.sort(numbers, axis=1)
    found: dict[tuple[int, int], BodyPair] = {}
    distinct, group = np.unique(keys, axis=0, return_inverse=True)
    members = _grouped(group.reshape(-1), len(distinct))
    for key, here in zip(distinct, members):
        met = _Meeting(pairs[between[here]], numbers[here], depth[here], limit[here])
        found[tuple(key.tolist())] = pair = _judged(mesh, key, count, met, allowed, least)
        deep[here] = pair.kind == OVERLAP
        if pair.kind == TOUCH and (key >= count).all():
            faces = np.sort(mesh.face_ids[met.pairs], axis=1)
            if set(map(tuple, np.unique(faces, axis=0).tolist())) <= edge_to_edge:
                del found[tuple(key.tolist())]
    for key, pair in _without_crossing(mesh, closed, allowed, least, found).items():
        found[key] = pair
        for k in np.flatnonzero((distinct == key).all(axis=1)):
            deep[members[k]] = pair.kind == OVERLAP
    own[between] = deep & (keys >= count).any(axis=1)
    kinds = [
        tuple(pair for pair in found.values() if pair.kind == kind)
        for kind in (OVERLAP, TOUCH, NEAR)
    ]
    over = tuple(pair for pair in kinds[0] if -1 not in pair.solids)
    return Bodies(own, int((~deep).sum()), over, *kinds[1:])


def _grouped(group: NDArray[np.integer[Any]], count: int) -> list[NDArray[np.intp]]:
    """The rows of each of ``count`` groups."""
    order = np.argsort(group, kind="stable")
    return np.split(order, np.searchsorted(group[order], np.arange(1, count)))


class _Meeting(NamedTuple):
    """Pairs of triangles of two bodies that meet."""

    pairs: NDArray[np.int32]  # (k, 2)
    bodies: NDArray[np.int64]  # (k, 2)
    depth: NDArray[np.float64]  # (k,)
    limit: NDArray[np.float64]  # (k,) of the depth that facets of a contact may have


def _judged(
    mesh: SurfaceMesh, key: NDArray, count: int, met: _Meeting, allowed: NDArray, least: float
) -> BodyPair:
    """Do two bodies whose triangles meet overlap, touch, or only lie near?"""
    worst = int(np.argmax(met.depth / met.limit))
    depth, place = float(met.depth[worst]), _meeting_point(mesh, met.pairs[worst])
    kind, gap = OVERLAP if depth > met.limit[worst] else TOUCH, None
    known = KnownSurfaces.of(mesh)
    of_solids = bool((key < count).all())
    if kind == OVERLAP and of_solids:  # triangles that cross go no deeper than they are large
        deepest = overlap_depth(mesh, (int(key[0]), int(key[1])))
        if deepest.depth > depth:
            depth, place = deepest
    if kind == TOUCH and of_solids and known is not None:
        true = true_depth(known, met.pairs, met.bodies, met.limit)
        if not true.depth > least:  # corners of the triangles that meet do not tell
            solids = (int(key[0]), int(key[1]))
            seen = true_depth_of_faces(known, solids, allowed, least)
            true = max(true, seen, key=lambda one: one.depth)
        if true.depth > least + 2.0 * true.deviation:
            kind, depth, place = OVERLAP, true.depth, true.point
        elif np.isfinite(true.depth) and -true.depth > least + 2.0 * true.deviation:
            kind, gap, place = NEAR, -true.depth, true.point
    return _pair(mesh, key, count, kind, len(met.pairs), depth, gap, place)


def _apart(mesh: SurfaceMesh, pairs: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(k,) which pairs of triangles belong to two bodies.

    They bound no solid in common, but one each, or hang together by no vertex.
    """
    if not len(pairs):
        return np.zeros(0, bool)
    first, second = solids_beside(mesh)[pairs[:, 0]], solids_beside(mesh)[pairs[:, 1]]
    common = (first[:, :, None] == second[:, None, :]) & (first[:, :, None] >= 0)
    each = (first >= 0).any(axis=1) & (second >= 0).any(axis=1)
    pieces = vertex_components(mesh)[mesh.triangles[pairs][:, :, 0]]
    return ~common.any(axis=(1, 2)) & (each | (pieces[:, 0] != pieces[:, 1]))


def _beside_rims(
    mesh: SurfaceMesh, pairs: NDArray[np.int32], edge_to_edge: Set[tuple[int, int]]
) -> NDArray[np.bool_]:
    """(k,) which pairs lie at free rims of faces of no solid, and these along each other: as if
    they were of two bodies."""
    if not len(pairs) or not edge_to_edge:
        return np.zeros(len(pairs), bool)
    at_rim = np.zeros(len(mesh.points), bool)
    at_rim[mesh.edges[mesh.connectivity.uses == 1]] = True
    width = np.array([int(mesh.face_ids.max()) + 1, 1], np.int64)
    faces = np.sort(mesh.face_ids[pairs], axis=1) @ width
    along = np.isin(faces, np.array(list(edge_to_edge), np.int64) @ width)
    sheets = (solids_beside(mesh)[pairs] < 0).all(axis=(1, 2))
    corners = at_rim[mesh.triangles[pairs]].sum(axis=2)  # (k, 2) that lie at a rim
    return along & sheets & (corners.min(axis=1) > 0)


def _body_numbers(mesh: SurfaceMesh, count: int) -> NDArray[np.int64]:
    """(m,) the first solid of each triangle, or ``count`` and the number of its piece."""
    behind, before = solids_beside(mesh).astype(np.int64).T
    piece = count + vertex_components(mesh)[mesh.triangles[:, 0]].astype(np.int64)
    return np.where(behind >= 0, behind, np.where(before >= 0, before, piece))


def _depths(mesh: SurfaceMesh, pairs: NDArray[np.int32]) -> NDArray[np.float64]:
    parts = [
        depths(mesh.points[mesh.triangles[pairs[start : start + BLOCK]]])
        for start in range(0, len(pairs), BLOCK)
    ]
    return np.concatenate(parts) if parts else np.empty(0)


def _meeting_point(mesh: SurfaceMesh, pair: NDArray[np.int32]) -> NDArray[np.float64]:
    corners = mesh.points[mesh.triangles[pair]]
    return (corners.min(axis=1).max(axis=0) + corners.max(axis=1).min(axis=0)) / 2.0


def _pair(
    mesh: SurfaceMesh, key: NDArray, count: int, kind: str, triangles: int,
    depth: float | None, gap: float | None, place: NDArray,
) -> BodyPair:  # fmt: skip
    numbers = [int(k) if k < count else -1 for k in key]
    names = [
        mesh.groups.solid_label(number) if number >= 0 else _piece_name(mesh, int(k) - count)
        for k, number in zip(key, numbers)
    ]
    return BodyPair(
        (names[0], names[1]), (numbers[0], numbers[1]), kind, triangles, depth, gap,
        as_point(place),
    )  # fmt: skip


def _piece_name(mesh: SurfaceMesh, vertex: int) -> str:
    """The first face of the piece of faces that begins with this vertex."""
    triangle = int(np.flatnonzero((mesh.triangles == vertex).any(axis=1))[0])
    return mesh.face_name(int(mesh.face_ids[triangle]))


class _Solid(NamedTuple):
    """The triangles of a solid, facing outwards, and points to look at beside its faces."""

    corners: NDArray[np.float64]  # (m, 3, 3)
    low: NDArray[np.float64]  # (3,) of the box around them
    high: NDArray[np.float64]
    probes: NDArray[np.float64]  # (k, 3) middles of triangles that bound no other solid
    outwards: NDArray[np.float64]  # (k, 3) unit normals there
    allowed: NDArray[np.float64]  # (k,) depth of facets there
    most: float  # anywhere


class _Solids:
    """Solids of a mesh and their boxes; the rest of one is found when it is first asked for."""

    def __init__(self, mesh: SurfaceMesh, numbers: list[int]) -> None:
        self.numbers, self._mesh = numbers, mesh
        beside = solids_beside(mesh)
        count = int(beside.max(initial=-1)) + 1
        low, high = solid_boxes(mesh.points, mesh.triangles, beside, count)
        self._low, self._high = low[numbers], high[numbers]
        self._found: dict[int, _Solid] = {}

    @cached_property
    def _rows(self) -> list[NDArray[np.intp]]:
        """The triangles of each."""
        of = solids_beside(self._mesh).ravel()
        rows = np.repeat(np.arange(len(self._mesh.triangles)), 2)[of >= 0]
        members = _grouped(of[of >= 0], int(of.max()) + 1)
        return [rows[members[number]] for number in self.numbers]

    def found(self, number: int, allowed: NDArray[np.float64]) -> _Solid:
        """What a solid is like. allowed: (m,) the depth that facets of a contact may have."""
        if number not in self._found:
            k = self.numbers.index(number)
            sides = self._low[k], self._high[k]
            self._found[number] = _solid(self._mesh, number, self._rows[k], sides, allowed)
        return self._found[number]

    def are_apart(self, margin: float) -> bool:
        """Do no two boxes come within a margin of each other?"""
        return not any(map(len, (self.near(number, margin) for number in self.numbers)))

    def near(self, number: int, margin: float) -> list[int]:
        """The others whose boxes come within a margin of that of ``number``."""
        k = self.numbers.index(number)
        near = (self._low[k] <= self._high + margin).all(axis=1)
        near &= (self._low <= self._high[k] + margin).all(axis=1)
        near[k] = False
        return [self.numbers[i] for i in np.flatnonzero(near)]


def _solid(
    mesh: SurfaceMesh, number: int, rows: NDArray[np.intp], sides: tuple[NDArray, NDArray],
    allowed: NDArray[np.float64],
) -> _Solid:  # fmt: skip
    """rows: its triangles; sides: low and high of the box around them."""
    corners = mesh.points[mesh.triangles[rows]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal[solids_beside(mesh)[rows, 0] != number] *= -1.0
    size = np.linalg.norm(normal, axis=1)
    order = np.lexsort((-size, mesh.face_ids[rows]))
    faces = mesh.face_ids[rows][order]
    rank = np.arange(len(rows)) - np.searchsorted(faces, faces)
    alone = (solids_beside(mesh)[rows[order]] >= 0).sum(axis=1) == 1
    chosen = order[(rank < PROBES) & (size[order] > 0.0) & alone]
    return _Solid(
        corners, *sides,
        corners[chosen].mean(axis=1), normal[chosen] / size[chosen, None], allowed[rows[chosen]],
        float(allowed[rows].max()),
    )  # fmt: skip


def _without_crossing(
    mesh: SurfaceMesh, closed: _Solids, allowed: NDArray[np.float64], least: float,
    found: dict[tuple[int, int], BodyPair],
) -> dict[tuple[int, int], BodyPair]:  # fmt: skip
    """Pairs of closed solids of which one lies within the other, or in one place, or that touch,
    where the triangles that meet have not shown it."""
    more: dict[tuple[int, int], BodyPair] = {}
    for number in closed.numbers:
        for other in closed.near(number, least):
            key = (min(number, other), max(number, other))
            known = more.get(key, found.get(key))
            if known is not None and known.kind == OVERLAP:
                continue
            deep, touch = _probed(
                closed.found(number, allowed), closed.found(other, allowed), least
            )
            place = touch if deep is None else deep
            if place is None or (known is not None and deep is None):
                continue
            met = 0 if known is None else known.triangles
            kind = TOUCH if deep is None else OVERLAP
            more[key] = _pair(
                mesh, np.array(key), max(closed.numbers) + 1, kind, met, None, None, place
            )
    return more


def _probed(one: _Solid, other: _Solid, least: float) -> tuple[NDArray | None, NDArray | None]:
    """A point that is within both solids, and one where the faces of ``one`` touch ``other``."""
    depth = one.allowed + other.most + least
    points = one.probes - depth[:, None] * one.outwards
    deep = None
    for k in _within(points, other):
        if inside(points[k : k + 1], one.corners)[0] and all(
            triangle_distances(points[k][None], part.corners).min() > CLEAR * depth[k]
            for part in (one, other)
        ):
            deep = points[k]
            break
    beside = one.probes + least * one.outwards
    touching = _within(beside, other)
    return deep, beside[touching[0]] if len(touching) else None


def _within(points: NDArray[np.float64], solid: _Solid) -> NDArray[np.intp]:
    """Which points lie within a solid."""
    near = np.flatnonzero(((points >= solid.low) & (points <= solid.high)).all(axis=1))
    return near[inside(points[near], solid.corners)] if len(near) else near
