"""What is asked of the edges of a CAD model by themselves: the rules at samples of edges.

    for each set of sizes that holds there: rules of their own curvature, of the faces' curvature,
    of the place -> least, within the bounds of that set -> least of all sets

All edges that hear a set of sizes are looked at together. The sampler takes the least, ``explain``
names it.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from surfmesh._core.edges import curvatures_along, edge_courses, rows_of
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.model_arrays import ModelArrays, counts_of, model_arrays, offsets
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.direction_rates import has_even_curvature
from surfmesh.sizing.rules.direction_size import size_along
from surfmesh.sizing.rules.rule import CurveSamples, Rule
from surfmesh.sizing.rules.size_rules import SizeRules

NARROWEST = 5e-4
"""Gaps narrower and edges shorter than this fraction of the diagonal do not ask for still smaller
sizes by themselves: the mesh would be flooded by what is too small to matter."""

TOGETHER = 128
"""Coedges that are looked at together where sizes depend on the direction: memory for all would be
too much."""

SPARED = 1.4
"""Of ``min_size``: shorter segments are not cut because they sag."""


class Demand(NamedTuple):
    """What one rule asks for along edges."""

    rule: Rule | None
    """None: those by curvature of a face together, where sizes depend on the direction."""
    rows: np.ndarray | None
    """(k,) among the samples that hear the set of sizes; None: all of them. A sample between two
    curved faces is there twice."""
    sizes: np.ndarray
    """(k,) there, not within bounds."""
    coedges: np.ndarray | None = None
    """(k,) on whose faces the curvature is."""
    curvatures: tuple[np.ndarray, ...] = ()
    """(k,) each, those that it follows, 1 / model unit: two of a face, one of the edge itself."""


class DemandsOfOne(NamedTuple):
    """What one set of sizes asks for."""

    rules: SizeRules
    rows: np.ndarray | None
    """(m,) the samples that hear it; None: all."""
    of_faces: np.ndarray | None
    """(k,) that have these sizes, some more than once; None: the edge itself has them."""
    demands: list[Demand]

    @property
    def faces(self) -> tuple[int, ...]:
        """That have these sizes; none: those of the edge itself."""
        return () if self.of_faces is None else tuple(dict.fromkeys(self.of_faces.tolist()))

    def least(self, count: int) -> np.ndarray:
        """(m,) within the bounds; count: m."""
        size = np.full(count, self.rules.clamp[1])
        for demand in self.demands:
            if demand.rows is None:
                np.minimum(size, demand.sizes, out=size)
            else:
                np.minimum.at(size, demand.rows, demand.sizes)
        return np.maximum(size, self.rules.clamp[0], out=size)


class Courses(NamedTuple):
    """Some edges at n samples in all."""

    edges: np.ndarray  # (k,) int64, rising
    first: np.ndarray  # (k + 1,) int64: samples of each
    fraction: np.ndarray  # (n,) of its parameter range
    points: np.ndarray  # (n, 3)
    curvature: np.ndarray  # (n,) 1 / model unit; 0 where it is straight or not known
    tangent: np.ndarray  # (n, 3) unit
    total_curvature: np.ndarray  # (k,) its integral along each edge, radians

    @classmethod
    def of(
        cls, arrays: ModelArrays, edges: np.ndarray, first: np.ndarray, fraction: np.ndarray
    ) -> "Courses":
        straight = arrays.straight[edges].astype(np.uint8)
        found = edge_courses(arrays.curves, edges, first, fraction, straight)
        points, tangent, curvature, total = found
        return cls(edges, first, fraction, points, curvature, tangent, total)

    def chosen(self, which: np.ndarray) -> tuple["Courses", np.ndarray]:
        """Those of some edges (rows of ``edges``), and their samples here."""
        rows = rows_of(self.first, which)
        first = offsets(self.first[which + 1] - self.first[which])
        return Courses(
            self.edges[which], first, self.fraction[rows], self.points[rows], self.curvature[rows],
            self.tangent[rows], self.total_curvature[which],
        ), rows  # fmt: skip


class _Hearing(NamedTuple):
    """A set of sizes, and who hears it."""

    sizing: Sizing
    edges: np.ndarray  # int64, rising
    coedges: np.ndarray  # int64, of the faces that have these sizes, or of the edges that do
    is_of_edges: bool = False  # they have them themselves


@dataclass
class EdgeRules:
    """What the sizes of a model ask of its edges."""

    model: CadModel
    wanted: ModelSizing
    arrays: ModelArrays = field(init=False)
    _coedges_of: np.ndarray = field(init=False)  # coedges in the order of their edges
    _first_coedge: np.ndarray = field(init=False)  # (e + 1,) where those of each edge begin
    _rules: dict[int, SizeRules] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        self.arrays = model_arrays(self.model)
        self._first_coedge, self._coedges_of = self.arrays.coedges_of_edges

    def coedges_of(self, edge: int) -> np.ndarray:
        """The coedges of an edge."""
        return self._coedges_of[self._first_coedge[edge] : self._first_coedge[edge + 1]]

    def faces_of(self, edge: int) -> list[int]:
        """Their faces."""
        return self.arrays.coedge_face[self.coedges_of(edge)].tolist()

    def sizings_at(self, edge: int) -> list[Sizing]:
        """Each set of sizes that holds along an edge, once: of its faces, then its own."""
        return [own.sizing for own in self._hearings(np.array([edge]))]

    def rules_of(self, sizing: Sizing) -> SizeRules:
        """The rules of a set of sizes, made once."""
        if id(sizing) not in self._rules:
            self._rules[id(sizing)] = SizeRules.of(sizing, self.model.diagonal)
        return self._rules[id(sizing)]

    def demands(self, courses: Courses, left_out: Collection[int] = ()) -> Iterator[DemandsOfOne]:
        """Of each set of sizes that some of the edges hear: faces that differ are heard one after
        the other, then the edges. left_out: faces whose curvature is not asked for."""
        for own in self._hearings(courses.edges):
            rules = self.rules_of(own.sizing)
            edges, coedges = own.edges, own.coedges
            heard, rows = courses, None
            if len(edges) < len(courses.edges):
                heard, rows = courses.chosen(np.searchsorted(courses.edges, edges))
            faces = self.arrays.coedge_face[coedges]
            of_faces = None if own.is_of_edges else faces
            if left_out:
                coedges = coedges[~np.isin(faces, list(left_out))]
            yield DemandsOfOne(rules, rows, of_faces, list(self._demands_of(rules, heard, coedges)))

    def target_size(self, courses: Courses, left_out: Collection[int] = ()) -> np.ndarray:
        """The least of all demands (n,), and no more than the edge is long."""
        count = counts_of(courses.first)
        longest = np.maximum(self.arrays.length[courses.edges], NARROWEST * self.model.diagonal)
        size, floor = np.repeat(longest, count), np.array(np.inf)  # one for all, or (n,)
        for own in self.demands(courses, left_out):
            finest = own.rules.clamp[0]
            if own.rows is None:
                np.minimum(size, own.least(len(size)), out=size)
                np.minimum(floor, finest, out=floor)
            else:
                size[own.rows] = np.minimum(size[own.rows], own.least(len(own.rows)))
                floor = np.broadcast_to(floor, len(size)).copy() if floor.ndim == 0 else floor
                floor[own.rows] = np.minimum(floor[own.rows], finest)
        return np.maximum(size, floor, out=size)

    def sags(self) -> tuple[np.ndarray, np.ndarray]:
        """What segments of each edge (e,) may sag by at most, infinite where nothing is asked of
        it or it is straight; and how long a segment is that is not cut for it."""
        count = len(self.model.edges)
        chord, shortest = np.full(count, np.inf), np.zeros(count)
        for own in self._hearings(self.arrays.bent_edges):
            edges, allowed = own.edges, own.sizing.straight_chord
            if allowed is not None:
                chord[edges] = np.minimum(chord[edges], allowed)
            least = SPARED * (own.sizing.min_size or 0.0)
            shortest[edges] = np.maximum(shortest[edges], least)
        return chord, np.maximum(shortest, chord)

    def at_vertex(self, number: int) -> float:
        """Largest size at a vertex of which something is asked."""
        rules = self.rules_of(self.wanted.vertices[number])
        point = self.model.vertices[number].point[None]
        return float(np.clip(rules.from_place(point), *rules.clamp)[0])

    def _hearings(self, edges: np.ndarray) -> list[_Hearing]:
        """The sets of sizes that some edges hear."""
        wanted, face_of = self.wanted, self.arrays.coedge_face
        if not wanted.faces and not wanted.edges:
            coedges = self._coedges_of[rows_of(self._first_coedge, edges)]
            return [_Hearing(wanted.base, edges, coedges)]
        by_faces: dict[int, tuple[Sizing, list[int], list[int]]] = {}
        by_edges: dict[int, tuple[Sizing, list[int], list[int]]] = {}

        def add(
            found: dict[int, tuple[Sizing, list[int], list[int]]], sizing: Sizing, edge: int,
            coedges: list[int],
        ) -> None:  # fmt: skip
            _, own, own_coedges = found.setdefault(id(sizing), (sizing, [], []))
            if not own or own[-1] != edge:
                own.append(edge)
            own_coedges.extend(coedges)

        for edge in edges.tolist():
            coedges = self.coedges_of(edge).tolist()
            for coedge in coedges:
                add(by_faces, wanted.of_face(int(face_of[coedge])), edge, [coedge])
            if not coedges:  # of no face
                add(by_faces, wanted.base, edge, [])
            if edge in wanted.edges:
                add(by_edges, wanted.edges[edge], edge, coedges)
        return [
            _Hearing(
                sizing, np.array(own, np.int64), np.array(coedges, np.int64), found is by_edges
            )
            for found in (by_faces, by_edges)
            for sizing, own, coedges in found.values()
        ]

    def _demands_of(
        self, rules: SizeRules, courses: Courses, coedges: np.ndarray
    ) -> Iterator[Demand]:
        yield from self._by_own_curvature(rules, courses)
        if rules.follows_curvature:
            surfaces = [self.model.faces[face].surface for face in self.arrays.coedge_face[coedges]]
            curved = np.array([surface.kind != "plane" for surface in surfaces], bool)
            along = self._directed if rules.sizing.is_anisotropic else self._by_curvature
            yield from along(rules, courses, coedges[curved])
        for place_rule, sizes in rules.at_points(courses.points):
            yield Demand(place_rule, None, sizes)

    def _by_own_curvature(self, rules: SizeRules, courses: Courses) -> Iterator[Demand]:
        if not rules.follows_curvature:
            return
        bent = np.flatnonzero(~self.arrays.straight[courses.edges])
        if not len(bent):
            return
        own, rows = courses.chosen(bent)
        tolerance = np.repeat(self.arrays.tolerance[own.edges], counts_of(own.first))
        curve = CurveSamples(own.points, own.curvature, own.first, tolerance)
        for rule in rules.by_curvature:
            yield Demand(rule, rows, rule.sizes_on_curve(curve), None, (curve.curvature,))

    def _by_curvature(
        self, rules: SizeRules, courses: Courses, coedges: np.ndarray
    ) -> Iterator[Demand]:
        """What the curvature of faces asks for along their edges; looked up once where it is the
        same everywhere."""
        if not len(coedges):
            return
        arrays = self.arrays
        surfaces = [self.model.faces[face].surface for face in arrays.coedge_face[coedges]]
        even = np.array([has_even_curvature(surface) for surface in surfaces], bool)
        of = np.searchsorted(courses.edges, arrays.coedge_edge[coedges])
        count = courses.first[of + 1] - courses.first[of]
        looked_at = np.where(even, 1, count)
        first = offsets(looked_at)
        places = np.repeat(courses.first[of] - first[:-1], looked_at) + np.arange(first[-1])
        k1, k2, degenerate = curvatures_along(
            arrays.pcurves, coedges, first, courses.fraction[places],
            [surface.core for surface in surfaces],
        )  # fmt: skip
        rows = rows_of(courses.first, of)
        start = offsets(count)
        value = np.repeat(first[:-1], count)  # of the samples, among those looked at
        along = np.arange(start[-1]) - np.repeat(start[:-1], count)
        value += np.where(np.repeat(even, count), 0, along)
        whose = np.repeat(coedges, count)
        for rule, sizes in rules.at_curvature(k1, k2):
            sizes = np.where(degenerate.astype(bool) | ~np.isfinite(sizes), np.inf, sizes)
            yield Demand(rule, rows, sizes[value], whose, (k1[value], k2[value]))

    def _directed(
        self, rules: SizeRules, courses: Courses, coedges: np.ndarray
    ) -> Iterator[Demand]:
        """The same where sizes depend on the direction, of so many coedges at a time."""
        arrays = self.arrays
        for start in range(0, len(coedges), TOGETHER):
            some = coedges[start : start + TOGETHER]
            of = np.searchsorted(courses.edges, arrays.coedge_edge[some])
            count = courses.first[of + 1] - courses.first[of]
            first, rows = offsets(count), rows_of(courses.first, of)
            places = arrays.pcurves.points(some, first, courses.fraction[rows])[:, :2]
            uv = np.split(np.ascontiguousarray(places), first[1:-1])
            surfaces = [self.model.faces[face].surface for face in arrays.coedge_face[some]]
            sizes = size_along(surfaces, uv, courses.tangent[rows], rules)
            yield Demand(None, rows, sizes, np.repeat(some, count))
