"""Where the edges of each of two complexes meet the faces and edges of the other: nodes.

A node is one place in space: an old vertex, or a new one. It knows at which fraction of an edge it
lies, and at which (u, v) inside a face. What edges and faces share is the node's number.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace, CadVertex
from surfmesh.errors import SurfaceError
from surfmesh.intersection.bounds import Boxes as CellBoxes
from surfmesh.intersection.cells import EdgePieces, FaceCells
from surfmesh.intersection.complex import Complex
from surfmesh.intersection.newton import unit_normals
from surfmesh.intersection.piercings import crossings
from surfmesh.intersection.regions import Region
from surfmesh.intersection.tracing import place

SAME = 1e-8
"""Of the diagonal: places nearer than that are one."""

TANGENT_PLANES = 1e-5
"""Sine of the angle between planes that are taken for one."""

SEARCHED = 129
"""Points of an edge among which the nearest to a point is looked for first."""


class Boxes(NamedTuple):
    """Around whole faces or edges, (n, 3) each."""

    low: np.ndarray
    high: np.ndarray


class Side:
    """One of two complexes: its faces with their cells, regions and boxes, where edges are cut."""

    def __init__(self, whole: Complex, first_node: int) -> None:
        self.whole = whole
        self.first_node = first_node
        self.cells = [FaceCells(patch.face) for patch in whole.patches]
        self.regions = [Region(patch.face) for patch in whole.patches]
        self.boxes = _stacked([_box(cells.bounds(cells.start(), 0)[0]) for cells in self.cells])
        self.edge_boxes = _stacked([_edge_box(edge) for edge in whole.edges])
        self.cuts: list[dict[int, float]] = [{} for _ in whole.edges]
        """For each edge the nodes within it, each with its fraction."""
        self.inner: list[dict[int, list[np.ndarray]]] = [{} for _ in whole.patches]
        """For each face the nodes in its inside, each with its places in (u, v)."""

    def faces_near(self, boxes: Boxes, k: int) -> Iterator[int]:
        """Faces whose boxes meet box k of ``boxes``."""
        near = (self.boxes.low <= boxes.high[k]).all(1) & (boxes.low[k] <= self.boxes.high).all(1)
        yield from np.flatnonzero(near).tolist()


class Contacts:
    """Nodes of two complexes; size: the diagonal."""

    def __init__(self, p: Complex, q: Complex, size: float) -> None:
        self.same = SAME * size
        self.vertices: list[CadVertex] = [*p.vertices, *q.vertices]
        self.sides = Side(p, 0), Side(q, len(p.vertices))
        self.node_of = list(range(len(self.vertices)))
        """Nodes for which another one stands, as both are one place."""
        self._join_vertices(len(p.vertices))
        for own, other in (self.sides, self.sides[::-1]):
            for number, edge in enumerate(own.whole.edges):
                if edge.degenerate:
                    continue
                for face in other.faces_near(own.edge_boxes, number):
                    self._meet(own, number, other, face)

    def ends_of(self, side: Side, edge: CadEdge) -> tuple[int, int]:
        """The nodes at the start and at the end of an edge of one side."""
        first = side.first_node
        return self.node_of[first + edge.start], self.node_of[first + edge.end]

    def _join_vertices(self, count: int) -> None:
        if not 0 < count < len(self.vertices):
            return
        own = np.array([vertex.point for vertex in self.vertices])
        for k in range(count, len(own)):
            distance = np.linalg.norm(own[:count] - own[k], axis=1)
            near = int(np.argmin(distance))
            if distance[near] <= self.same:
                self.node_of[k] = near

    def node_at(self, point: np.ndarray) -> int:
        """The node at a point, a new one if there is none."""
        known = np.array([vertex.point for vertex in self.vertices])
        distance = np.linalg.norm(known - point, axis=1)
        near = int(np.argmin(distance)) if len(known) else -1
        if near >= 0 and distance[near] <= self.same:
            return self.node_of[near]
        self.vertices.append(CadVertex(point, self.same))
        self.node_of.append(len(self.vertices) - 1)
        return len(self.vertices) - 1

    def _meet(self, own: Side, number: int, other: Side, face: int) -> None:
        edge, patch = own.whole.edges[number], other.whole.patches[face]
        found = crossings(edge, other.cells[face], self.same)
        if found.along is not None:
            raise SurfaceError(
                f"an edge of {_label(own)} lies on {patch.face.surface.name or patch.face.kind}, "
                f"or touches it, at {place(found.along)}: such contacts are not intersected; "
                "move or change one of them"
            )
        for t, uv, point, touches in zip(found.fraction, found.uv, found.point, found.touches):
            met = self._edge_there(other, face, point)
            if met is None and not self._is_inside(other, face, uv):
                continue
            if touches:
                self._require_tangent_planes(own, number, float(t), patch.face, uv, point)
            node = self._cut(own, number, float(t), point)
            if met is not None:
                self._cut(other, *met, self.vertices[node].point)
                continue
            places = other.inner[face].setdefault(node, [])
            if not any(np.abs(uv - known).max() < 1e-6 for known in places):
                places.append(uv)

    def _require_tangent_planes(
        self, own: Side, number: int, t: float, other: CadFace, uv: np.ndarray, point: np.ndarray
    ) -> None:
        """Raise where an edge touches a face that none of its own faces touches there: a curve
        would come along the edge."""
        normal = unit_normals(other.surface, uv[None])
        for patch in own.whole.patches:
            for coedge in patch.face.coedges:
                if coedge.edge == number:
                    own_normal = unit_normals(patch.face.surface, coedge.uv(np.array([t])))
                    if np.linalg.norm(np.cross(normal, own_normal)) < TANGENT_PLANES:
                        return
        raise SurfaceError(
            f"an edge of {_label(own)} touches {other.surface.name or other.kind} at "
            f"{place(point)} without going through; move or change one of them"
        )

    def _cut(self, side: Side, number: int, fraction: float, point: np.ndarray) -> int:
        """The node where an edge is met: one of its ends, or a cut of it."""
        edge = side.whole.edges[number]
        for end in self.ends_of(side, edge):
            if np.linalg.norm(self.vertices[end].point - point) <= self.same:
                return end
        node = self.node_at(point)
        side.cuts[number].setdefault(node, fraction)
        return node

    def _edge_there(self, side: Side, face: int, point: np.ndarray) -> tuple[int, float] | None:
        """The edge of a face through a point, and the fraction; None for none."""
        for coedge in side.whole.patches[face].face.coedges:
            number = coedge.edge
            low, high = side.edge_boxes.low[number], side.edge_boxes.high[number]
            if ((point < low - self.same) | (point > high + self.same)).any():
                continue
            edge = side.whole.edges[number]
            if edge.curve is None:
                continue
            fraction, distance = nearest_on_edge(edge, point)
            if distance <= self.same + edge.tolerance:
                return number, fraction
        return None

    def _is_inside(self, side: Side, face: int, uv: np.ndarray) -> bool:
        region = side.regions[face]
        if region.distance(uv[None])[0] > 0.0:
            return bool(region.inside(uv[None])[0])
        return region.beside_curve(uv)


def nearest_on_edge(edge: CadEdge, point: np.ndarray) -> tuple[float, float]:
    """The fraction of an edge nearest to a point, and the distance."""
    fractions = np.linspace(0.0, 1.0, SEARCHED)
    distance = np.linalg.norm(edge.evaluate(fractions, 0)[0] - point, axis=1)
    t = fractions[int(np.argmin(distance))]
    rate = edge.t1 - edge.t0
    for _ in range(12):
        c, first, second = edge.evaluate(np.array([t]), 2)
        step, d1, d2 = c[0] - point, first[0] * rate, second[0] * rate**2
        slope, bend = float(step @ d1), float(d1 @ d1 + step @ d2)
        if not bend > 0.0:
            bend = float(d1 @ d1)
        if not bend > 0.0:
            break
        after = min(max(t - slope / bend, 0.0), 1.0)
        moved, t = abs(after - t), after
        if moved < 1e-16:
            break
    return float(t), float(np.linalg.norm(edge.evaluate(np.array([t]), 0)[0][0] - point))


def _label(side: Side) -> str:
    face = side.whole.patches[0].face
    return face.name or face.surface.name or face.kind


def _box(boxes: CellBoxes) -> tuple[np.ndarray, np.ndarray]:
    return boxes.low.min(axis=0), boxes.high.max(axis=0)


def _edge_box(edge: CadEdge) -> tuple[np.ndarray, np.ndarray]:
    if edge.curve is None:
        return np.full(3, np.inf), np.full(3, -np.inf)
    pieces = EdgePieces(edge)
    return _box(pieces.bounds(pieces.start(), 0)[0])


def _stacked(boxes: list[tuple[np.ndarray, np.ndarray]]) -> Boxes:
    low, high = (np.array(side).reshape(-1, 3) for side in zip(*boxes)) if boxes else (
        np.empty((0, 3)), np.empty((0, 3))
    )  # fmt: skip
    return Boxes(low, high)
