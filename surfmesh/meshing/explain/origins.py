"""Where sizes grow from: the place on a face, or on an edge, whose size reaches farthest below
others at a point.

What an edge asks for by itself is named by the rules that ``edge_samples`` has taken it from.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from surfmesh.meshing.edges.edge_rules import NARROWEST, Courses, Demand, DemandsOfOne, EdgeRules
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.meshing.edges.edge_sampling import MOST_LONGER
from surfmesh.meshing.explain.askers import DEFAULT, Askers, bound_row, words
from surfmesh.meshing.explain.axis_sizes import Elsewhere, Principal
from surfmesh.meshing.explain.rulings import (
    LARGEST,
    bound_rows,
    principal_rows,
    ruling,
    rulings,
    with_radius,
)
from surfmesh.meshing.explain.size_row import SizeRow, deciding
from surfmesh.sizing.field.size_law import FieldNodes, SizeLaw
from surfmesh.sizing.rules.size_rules import SizeRules


class InnerPlaces:
    """Points of a surface that sizes may have grown from."""

    def __init__(self, law: SizeLaw, askers: Askers, uv: np.ndarray, called: str = "") -> None:
        """uv: (n, 2). called: the beginning of their names."""
        self.law, self.askers, self.uv, self.called = law, askers, uv, called
        self.nodes = law(law.chart.to_plane(uv))

    def best(self, foot: np.ndarray, direction: np.ndarray | None = None) -> Elsewhere:
        """For a point (3,), along a unit tangent there; None: in every direction."""
        nodes, slope = self.nodes, self.law.sizing.gradient
        sizes = nodes.size if direction is None else self._sizes_along(nodes, direction)
        away = np.linalg.norm(nodes.point - foot, axis=1)
        k = int(np.argmin(sizes + slope * away))
        if direction is None:
            winner = ruling(self.law, self.askers, self.uv[k]).winner
        else:
            both = rulings(self.law, self.askers, self.uv[k])
            winner = max(both, key=lambda own: abs(float(own.direction @ direction))).winner
        name = f"{self.called}{at_point(nodes.point[k])}"
        return Elsewhere(float(sizes[k]), float(away[k]), name, winner)

    def _sizes_along(self, nodes: FieldNodes, direction: np.ndarray) -> np.ndarray:
        """(n,) of the metric at each place, infinite where the direction leaves the surface."""
        long = np.minimum(nodes.long, self.law.longest_along(nodes, nodes.size))
        onward = nodes.along @ direction
        across = np.cross(nodes.normal, nodes.along) @ direction
        with np.errstate(divide="ignore", invalid="ignore"):
            sizes = np.hypot(onward, across) / np.hypot(onward / long, across / nodes.size)
        return np.where(np.isfinite(sizes), sizes, np.inf)


class EdgePlaces(NamedTuple):
    """Samples of the edges of a model that sizes may have grown from."""

    rules: EdgeRules
    samples: EdgeSamples

    def best(self, foot: np.ndarray, direction: np.ndarray | None = None) -> Elsewhere:
        """For a point (3,), along a unit tangent there; None: in every direction.

        A size along an edge says nothing of directions across it.
        """
        samples, slope = self.samples, self.rules.wanted.base.gradient
        sizes = samples.target_size
        if direction is not None:
            sizes = sizes / np.maximum(np.abs(samples.tangent @ direction), np.finfo(float).eps)
        away = np.linalg.norm(samples.points - foot, axis=1)
        k = int(np.argmin(sizes + slope * away))
        edge = samples.edge_of(k)
        name = self.rules.model.edges[edge].name
        called = f"edge {edge}" + (f" ({name})" if name else "")
        where = f"{called} at {at_point(samples.points[k])}"
        return Elsewhere(float(sizes[k]), float(away[k]), where, self.winner(k))

    def winner(self, sample: int) -> SizeRow:
        """The rule that decides at a sample: of its faces, the edge, its ends, its gaps.

        Each set of sizes is heard within its own bounds; the smallest holds.
        """
        rules, samples = self.rules, self.samples
        edge = samples.edge_of(sample)
        item, target = rules.model.edges[edge], float(samples.target_size[sample])
        if samples.is_cut_by_shape(rules.model, edge):
            return SizeRow(DEFAULT, "the shape of a narrow tube, which its edge is cut by", target)
        own = samples.of(edge)
        t = samples.t[own]
        courses = Courses.of(rules.arrays, np.array([edge]), np.array([0, len(t)]), t)
        at = _OnEdge(rules, edge, courses, sample - own.start)
        every = list(rules.demands(courses, samples.narrow))
        found = [at.decided(one) for one in every]
        length = max(item.length, NARROWEST * rules.model.diagonal)
        found.append(SizeRow(DEFAULT, f"length {item.length:.4g} of edge {edge}", length))
        least, floor = (min(rows, key=_size) for rows in (found, map(at.floor, every)))
        found = [max(least, floor, key=_size)]
        ends = {0: item.start, own.stop - own.start - 1: item.end}
        vertex = ends.get(at.place, -1)
        if vertex in rules.wanted.vertices:
            found.append(_at_vertex(rules, vertex))
        for face in set(rules.faces_of(edge)) & samples.narrow.keys():
            rule = f"{MOST_LONGER:g} times the width of narrow face {face}"
            found.append(SizeRow(DEFAULT, rule, MOST_LONGER * samples.narrow[face].width))
        gap = float(samples.gap_size[sample])
        if gap < np.inf:
            found.append(SizeRow("gap", "gap to another edge of a face", gap))
        return min(found, key=_size)


class _OnEdge(NamedTuple):
    """A sample of an edge."""

    rules: EdgeRules
    edge: int
    course: Courses
    place: int

    def decided(self, one: DemandsOfOne) -> SizeRow:
        """The row that decides within one set of sizes."""
        askers = self.askers(one)
        rows = [row for demand in one.demands for row in self._rows(demand, one.rules, askers)]
        rows += bound_rows(one.rules, askers)
        return deciding([*rows, self.floor(one)]) or SizeRow(DEFAULT, LARGEST, np.inf)

    def floor(self, one: DemandsOfOne) -> SizeRow:
        """The bound from below within one set of sizes."""
        floor = next(bound for bound in one.rules.bounds if bound.is_floor)
        return bound_row(self.askers(one).key_of(floor), floor)

    def askers(self, one: DemandsOfOne) -> Askers:
        """Whose the sizes are: of the first face that has them, or of the edge."""
        if one.faces:
            return Askers.of(self.rules.wanted, "faces", one.faces[0])
        return Askers.of(self.rules.wanted, "edges", self.edge)

    def _rows(self, demand: Demand, rules: SizeRules, askers: Askers) -> Iterator[SizeRow]:
        """What one rule asks for here, of each curved face that meets the edge."""
        rows = demand.rows
        at = [self.place] if rows is None else np.flatnonzero(rows == self.place).tolist()
        for row in at:
            size = float(demand.sizes[row])
            if not np.isfinite(size):
                continue
            if demand.rule is None:
                yield self._of_metric(demand, row, rules, askers)
                continue
            said = words(demand.rule)
            if demand.curvatures:
                k = [float(own[row]) for own in demand.curvatures]
                if len(k) == 2:
                    said += f" at curvatures {k[0]:.4g}, {k[1]:.4g}"
                elif k[0] > 0.0:
                    said += f" at the edge's own curvature {with_radius(k[0])}"
                else:
                    said += " at a corner of the edge"
            yield SizeRow(askers.key_of(demand.rule), said, size)

    def _of_metric(self, demand: Demand, row: int, rules: SizeRules, askers: Askers) -> SizeRow:
        """The rule of a face along the principal direction that is nearest to the edge."""
        assert demand.coedges is not None  # noqa: S101 for mypy: the metric is of a face
        arrays, number = self.rules.arrays, int(demand.coedges[row])
        face = self.rules.model.faces[arrays.coedge_face[number]]
        uv = arrays.coedges[number].uv(self.course.fraction[[self.place]])[0]
        principal = Principal.at(face.surface, uv)
        axis = principal.nearest(self.course.tangent[self.place])
        points = self.course.points[[self.place]]
        ratio, size = rules.sizing.anisotropy, float(demand.sizes[row])
        winner = deciding(principal_rows(rules, askers, principal.k, axis, points, ratio))
        return (winner or SizeRow("*", f"anisotropy {ratio:g}", size))._replace(size=size)


def _at_vertex(rules: EdgeRules, number: int) -> SizeRow:
    """The row that decides at a vertex of which something is asked."""
    askers = Askers.of(rules.wanted, "vertices", number)
    own = rules.rules_of(rules.wanted.vertices[number])
    point = rules.model.vertices[number].point[None]
    rows = [
        SizeRow(askers.key_of(rule), words(rule), float(sizes[0]))
        for rule, sizes in own.at_points(point)
    ]
    floors = [bound_row(DEFAULT, b) for b in own.bounds if b.is_floor and b.is_default]
    return deciding([*rows, *bound_rows(own, askers), *floors]) or SizeRow(DEFAULT, LARGEST, np.inf)


def at_point(point: np.ndarray) -> str:
    """A place in words."""
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ")"


def _size(row: SizeRow) -> float:
    return row.size
