"""Where the edges of each of two complexes meet the faces and edges of the other: nodes.

A node is one place in space: an old vertex, or a new one. It knows at which fraction of an edge it
lies, and at which (u, v) inside a face. What edges and faces share is the node's number.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadVertex
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Plane, Sphere, Torus
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import norm
from surfmesh.intersection.bounds import Boxes as CellBoxes
from surfmesh.intersection.cells import EdgeCells, FaceCells
from surfmesh.intersection.complex import Complex
from surfmesh.intersection.edge_meetings import meetings, nearest_on_edge
from surfmesh.intersection.elementary_distances import distance_to_elementary
from surfmesh.intersection.pcurve_fitting import nearest_on_surface
from surfmesh.intersection.piercings import crossings
from surfmesh.intersection.regions import Region

SAME = 1e-8
"""Of the diagonal: places nearer than that are one."""

LOOKED_AT = np.linspace(0.0, 1.0, 23)
"""Fractions of an edge at which it is compared with a surface."""


BESIDE = 0.01
"""Of an edge: how far off a touch it is looked whether the edge lies on the surface there."""


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

    def add_inner(self, face: int, node: int, uv: np.ndarray) -> None:
        """A node lies in the inside of a face."""
        places = self.inner[face].setdefault(node, [])
        if not any(np.abs(uv - known).max() < 1e-6 for known in places):
            places.append(uv)

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
        self.lying: list[tuple[Side, int, Side, int]] = []
        """Edges, a part of which lies on a surface: side and edge, other side and face."""
        self.unsure: list[tuple[Side, int, Side, int, np.ndarray]] = []
        """Of these, such as may only touch it: with the place."""
        self._met: set[tuple[int, int, int]] = set()
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
        if lies_on_elementary(edge, patch.face.surface, self.same):
            self._lies_on(own, number, other, face)
            return
        found = crossings(edge, other.cells[face], self.same)
        if found.along is not None:
            self._lies_on(own, number, other, face)
            self.unsure.append((own, number, other, face, found.along))
        for t, uv, point, touches in zip(found.fraction, found.uv, found.point, found.touches):
            if touches and found.along is not None and self._goes_on(edge, other, face, float(t)):
                continue
            met = self.edge_there(other, face, point)
            if met is None and not self.is_inside(other, face, uv):
                continue
            node = self._cut(own, number, float(t), point)
            if met is not None:
                self._cut(other, *met, self.vertices[node].point)
            else:
                other.add_inner(face, node, uv)

    def _goes_on(self, edge: CadEdge, other: Side, face: int, t: float) -> bool:
        """Does an edge lie on a surface on both sides of a touch as well?"""
        beside = np.clip([t - BESIDE, t + BESIDE], 0.0, 1.0)
        surface = other.whole.patches[face].face.surface
        away = nearest_on_surface(surface, edge.evaluate(beside, 0)[0])[1]
        return bool((away <= self.same + edge.tolerance).all())

    def _lies_on(self, own: Side, number: int, other: Side, face: int) -> None:
        """An edge lies on a surface, or a part of it does: it comes in and out of the face where it
        meets the edges of the face, or runs along these."""
        self.lying.append((own, number, other, face))
        edge = own.whole.edges[number]
        for second in dict.fromkeys(c.edge for c in other.whole.patches[face].face.coedges):
            key = (own.first_node, number, second)
            if own is self.sides[1]:
                key = (other.first_node, second, number)
            border = other.whole.edges[second]
            if border.degenerate or key in self._met or not self._may_meet(own, number, second):
                continue
            self._met.add(key)
            for t, s in meetings(edge, border, self.same):
                point = edge.evaluate(np.array([t]), 0)[0][0]
                node = self._cut(own, number, t, point)
                self._cut(other, second, s, self.vertices[node].point)

    def _may_meet(self, own: Side, number: int, second: int) -> bool:
        """Do the boxes of two edges meet?"""
        other = self.sides[1] if own is self.sides[0] else self.sides[0]
        one, two = own.edge_boxes, other.edge_boxes
        below = (one.low[number] <= two.high[second] + self.same).all()
        return bool(below and (two.low[second] <= one.high[number] + self.same).all())

    def _cut(self, side: Side, number: int, fraction: float, point: np.ndarray) -> int:
        """The node where an edge is met: one of its ends, or a cut of it."""
        edge = side.whole.edges[number]
        for end in self.ends_of(side, edge):
            if norm(self.vertices[end].point - point) <= self.same:
                return end
        node = self.node_at(point)
        side.cuts[number].setdefault(node, fraction)
        return node

    def edge_there(self, side: Side, face: int, point: np.ndarray) -> tuple[int, float] | None:
        """The edge of a face through a point (3,), and the fraction; None for none."""
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

    def is_inside(self, side: Side, face: int, uv: np.ndarray) -> bool:
        """Does a place (2,) lie within the loops of a face? On its border either may be said."""
        region = side.regions[face]
        if region.distance(uv[None])[0] > 0.0:
            return bool(region.inside(uv[None])[0])
        return region.beside_curve(uv)


def lies_on_elementary(edge: CadEdge, surface: FaceSurface, same: float) -> bool:
    """Does an edge lie on a plane, cylinder, cone, sphere or torus, taken as a whole?"""
    if not isinstance(surface, (Plane, Cylinder, Cone, Sphere, Torus)):
        return False
    points = edge.evaluate(LOOKED_AT, 0)[0]
    away = distance_to_elementary(surface, points)
    return bool((away <= same + edge.tolerance).all())


def label(side: Side) -> str:
    """What messages call one of both."""
    face = side.whole.patches[0].face
    return face.name or face.surface.name or face.kind


def _box(boxes: CellBoxes) -> tuple[np.ndarray, np.ndarray]:
    return boxes.low.min(axis=0), boxes.high.max(axis=0)


def _edge_box(edge: CadEdge) -> tuple[np.ndarray, np.ndarray]:
    if edge.curve is None:
        return np.full(3, np.inf), np.full(3, -np.inf)
    cells = EdgeCells(edge)
    return _box(cells.bounds(cells.start(), 0)[0])


def _stacked(boxes: list[tuple[np.ndarray, np.ndarray]]) -> Boxes:
    low, high = (np.array(side).reshape(-1, 3) for side in zip(*boxes)) if boxes else (
        np.empty((0, 3)), np.empty((0, 3))
    )  # fmt: skip
    return Boxes(low, high)
