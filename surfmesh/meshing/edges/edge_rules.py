"""What is asked of the edges of a CAD model by themselves: the rules at samples of one edge.

    for each set of sizes that holds there: rules of its own curvature, of the faces' curvature,
    of the place -> least, within the bounds of that set -> least of all sets

The sampler takes the least, ``explain`` names it.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from surfmesh._core import elementary_functions
from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadModel
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.direction_rates import has_even_curvature
from surfmesh.sizing.rules.direction_size import size_along
from surfmesh.sizing.rules.rule import CurveSamples, Rule
from surfmesh.sizing.rules.size_rules import SizeRules

NARROWEST = 5e-4
"""Gaps narrower and edges shorter than this fraction of the diagonal do not ask for still smaller
sizes by themselves: the mesh would be flooded by what is too small to matter."""

Uses = list[tuple[int, CadCoedge]]
"""Numbers of faces, with their coedges of one edge."""


class Demand(NamedTuple):
    """What one rule asks for along an edge."""

    rule: Rule | None
    """None: those by curvature of a face together, where sizes depend on the direction."""
    sizes: np.ndarray
    """(n,) at the samples, or (1,) where it is the same at all; not within bounds."""
    face: int | None = None
    """Whose curvature it follows."""
    curvatures: tuple[np.ndarray, ...] = ()
    """(n,) each, those that it follows, 1 / model unit: two of a face, one of the edge itself."""


class DemandsOfOne(NamedTuple):
    """What one set of sizes asks for."""

    rules: SizeRules
    faces: tuple[int, ...]
    """That have these sizes; none: those of the edge itself."""
    demands: list[Demand]

    def least(self, count: int) -> np.ndarray:
        """(count,) within the bounds."""
        size = np.full(count, self.rules.clamp[1])
        for demand in self.demands:
            np.minimum(size, demand.sizes, out=size)
        return np.maximum(size, self.rules.clamp[0])


class Course(NamedTuple):
    """An edge at n samples."""

    fraction: np.ndarray  # (n,) of its parameter range
    curve: CurveSamples
    tangent: np.ndarray  # (n, 3) unit
    is_straight: bool

    @classmethod
    def of(cls, edge: CadEdge, fraction: np.ndarray) -> "Course":
        if edge.is_straight:
            (points,) = edge.evaluate(fraction, 0)
            way = points[-1] - points[0]
            way = way / max(np.linalg.norm(way), np.finfo(float).tiny)
            flat = CurveSamples(points, np.zeros(len(points)))
            return cls(fraction, flat, np.tile(way, (len(points), 1)), True)
        points, first, second = edge.evaluate(fraction, 2)
        speed = np.linalg.norm(first, axis=1)
        tangent = first / np.maximum(speed, np.finfo(float).tiny)[:, None]
        bend = np.linalg.norm(np.cross(first, second), axis=1)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            curvature = np.nan_to_num(bend / (speed * speed * speed), nan=0.0, posinf=0.0)
        return cls(fraction, CurveSamples(points, curvature), tangent, False)

    @property
    def total_curvature(self) -> float:
        """Its integral along the edge, radians."""
        if self.is_straight:
            return 0.0
        cosine = np.einsum("ij,ij->i", self.tangent[1:], self.tangent[:-1])
        return float(elementary_functions.acos(np.clip(cosine, -1.0, 1.0)).sum())


@dataclass
class EdgeRules:
    """What the sizes of a model ask of its edges."""

    model: CadModel
    wanted: ModelSizing
    uses: list[Uses] = field(init=False)
    """Of each edge."""
    _rules: dict[int, SizeRules] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        self.uses = [[] for _ in self.model.edges]
        for number, face in enumerate(self.model.faces):
            for coedge in face.coedges:
                self.uses[coedge.edge].append((number, coedge))

    def sizings_at(self, edge: int) -> list[tuple[Sizing, Uses]]:
        """Each set of sizes that holds along an edge, with the uses that it is asked for: faces
        that differ are heard one after the other, then the edge itself."""
        found: dict[int, tuple[Sizing, Uses]] = {}
        for face, coedge in self.uses[edge]:
            own = self.wanted.of_face(face)
            found.setdefault(id(own), (own, []))[1].append((face, coedge))
        sizings = list(found.values()) or [(self.wanted.base, [])]  # an edge of no face
        if edge in self.wanted.edges:
            sizings.append((self.wanted.edges[edge], self.uses[edge]))
        return sizings

    def rules_of(self, sizing: Sizing) -> SizeRules:
        """The rules of a set of sizes, made once."""
        if id(sizing) not in self._rules:
            self._rules[id(sizing)] = SizeRules.of(sizing, self.model.diagonal)
        return self._rules[id(sizing)]

    def demands(
        self, edge: int, course: Course, left_out: Collection[int] = ()
    ) -> list[DemandsOfOne]:
        """left_out: faces whose curvature is not asked for."""
        found = []
        for sizing, uses in self.sizings_at(edge):
            rules = self.rules_of(sizing)
            users = [(face, coedge) for face, coedge in uses if face not in left_out]
            faces = tuple(dict.fromkeys(face for face, _ in uses))
            is_own = sizing is self.wanted.edges.get(edge)
            every = list(self._demands_of(rules, course, users))
            found.append(DemandsOfOne(rules, () if is_own else faces, every))
        return found

    def target_size(self, edge: int, course: Course, left_out: Collection[int] = ()) -> np.ndarray:
        """The least of all demands (n,), and no more than the edge is long."""
        model, count = self.model, len(course.fraction)
        size = np.full(count, max(model.edges[edge].length, NARROWEST * model.diagonal))
        every = self.demands(edge, course, left_out)
        for own in every:
            np.minimum(size, own.least(count), out=size)
        return np.maximum(size, min(own.rules.clamp[0] for own in every), out=size)

    def at_vertex(self, number: int) -> float:
        """Largest size at a vertex of which something is asked."""
        rules = self.rules_of(self.wanted.vertices[number])
        point = self.model.vertices[number].point[None]
        return float(np.clip(rules.from_place(point), *rules.clamp)[0])

    def _demands_of(self, rules: SizeRules, course: Course, uses: Uses) -> Iterator[Demand]:
        if not course.is_straight:
            own = (course.curve.curvature,)
            for rule in rules.by_curvature:
                yield Demand(rule, rule.sizes_on_curve(course.curve), None, own)
        for face, coedge in uses if rules.follows_curvature else ():
            surface = self.model.faces[face].surface
            if surface.kind == "plane":
                continue
            if rules.sizing.is_anisotropic:
                uv = coedge.uv(course.fraction)
                yield Demand(None, size_along(surface, uv, course.tangent, rules), face)
            else:
                some = course.fraction[:1] if has_even_curvature(surface) else course.fraction
                yield from _by_curvature(rules, face, surface, coedge.uv(some))
        for place_rule, sizes in rules.at_points(course.curve.points):
            yield Demand(place_rule, sizes)


def _by_curvature(
    rules: SizeRules, face: int, surface: Surface, uv: np.ndarray
) -> Iterator[Demand]:
    """What the face's curvature asks for along one of its edges."""
    forms = forms_from_derivatives(*surface.evaluate(uv, 2)[1:])
    k = curvatures(forms)
    for rule, sizes in rules.at_curvature(k.k1, k.k2):
        unknown = forms.degenerate | ~np.isfinite(sizes)
        yield Demand(rule, np.where(unknown, np.inf, sizes), face, (k.k1, k.k2))
