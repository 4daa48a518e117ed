"""The edges of two complexes cut at nodes: the parts that are one, and those that lie in faces.

o------o-----------o        A part of an edge of the one and a part of an edge of the other
|one   |   both    |        between the same nodes, which run together, become one edge. A part
o------o===========o---o    of an edge that lies in the inside of a face of the other complex
       |         other |    becomes a curve on it: no other curve is looked for there.
       o---------------o
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace
from surfmesh.errors import SurfaceError
from surfmesh.intersection.borders import Part
from surfmesh.intersection.complex import part_of_edge
from surfmesh.intersection.contacts import Contacts, Side, label
from surfmesh.intersection.edge_meetings import nearest_on_edge
from surfmesh.intersection.newton import unit_normals
from surfmesh.intersection.pcurve_fitting import as_edge_runs, followed, nearest_on_surface
from surfmesh.intersection.poles import contact_at_pole, fraction_at_pole, ways_out_of_pole
from surfmesh.intersection.tracing import place

QUARTERS = np.array([0.25, 0.5, 0.75])
"""Of a part of an edge: where it is compared with another, or with a face."""

ONE_PLACE = 1e-6
"""Of the range of a degenerate edge: ways out of a pole so near to each other are one."""


class EdgePart(NamedTuple):
    """A part of an edge: its number among those of the whole, the fractions of the old edge
    between which it lies, and whether the new edge runs the other way."""

    edge: int
    first: float
    last: float
    turned: bool


class Lying(NamedTuple):
    """An edge that lies in a face of side ``which``: places (n + 1, 2) there at even fractions."""

    edge: int
    which: int
    face: int
    places: np.ndarray


class EdgeParts:
    """Of the edges of both sides of contacts. edges: all parts, each once."""

    def __init__(self, contacts: Contacts) -> None:
        self.contacts = contacts
        self.edges: list[CadEdge] = []
        self.edge_parts: dict[tuple[int, int], list[EdgePart]] = {}
        self.lying: list[Lying] = []
        self.leaving: dict[tuple[int, bool], tuple[np.ndarray | None, np.ndarray | None, int]] = {}
        """Where a part of a degenerate edge starts, or starts when walked backwards, the curve
        that leaves the pole: its way (3,), its rate (2,) in (u, v), the face it is common with."""
        self.touched_poles: list[tuple[int, int, int, int]] = []
        """Side and face of a pole that a face of the other side touches, that face, the node."""
        self._between: dict[frozenset[int], list[int]] = {}
        """Parts of the first side by their nodes."""
        self._made: dict[tuple[int, int, int], CadCoedge] = {}
        for which, side in enumerate(contacts.sides):
            for number, edge in enumerate(side.whole.edges):
                if not edge.degenerate:
                    self._add(which, side, number, edge)
        self._find_lying()
        for which, side in enumerate(contacts.sides):
            for number, edge in enumerate(side.whole.edges):
                if edge.degenerate:
                    self._add_pole(which, side, number, edge)

    def parts_of(self, side: Side, face: CadFace, coedge: CadCoedge) -> list[Part]:
        """A coedge of a face cut at the nodes, in walking order."""
        which = self.contacts.sides.index(side)
        found = []
        for edge_part in self.edge_parts[(which, coedge.edge)]:
            part = self._use(which, side, face, coedge, edge_part)
            made = self.edges[edge_part.edge]
            leaving = self.leaving.get((edge_part.edge, part.reversed), (None, None, -1))
            node = made.end if part.reversed else made.start
            found.append(Part(part, node, made.degenerate, leaving))
        return found[::-1] if coedge.reversed else found

    def _use(
        self, which: int, side: Side, face: CadFace, coedge: CadCoedge, edge_part: EdgePart
    ) -> CadCoedge:
        """The use of a part; of one that is an edge of the other side at the pace of that."""
        p0, p1 = coedge.p0 + np.array([edge_part.first, edge_part.last]) * (coedge.p1 - coedge.p0)
        part = replace(coedge, edge=edge_part.edge, p0=float(p0), p1=float(p1))
        if which == 0 or not self._is_shared(edge_part.edge):
            return part
        edge = self.edges[edge_part.edge]
        made, off = as_edge_runs(part, edge, edge_part.turned, face.surface, edge.tolerance)
        if off > edge.tolerance:
            self.edges[edge_part.edge] = replace(edge, tolerance=1.1 * off)
        return replace(made, edge=edge_part.edge)

    def _is_shared(self, edge: int) -> bool:
        return edge < self._count_first

    def _add(self, which: int, side: Side, number: int, edge: CadEdge) -> None:
        start, end = self.contacts.ends_of(side, edge)
        cuts = sorted((t, node) for node, t in side.cuts[number].items())
        stops = [(0.0, start), *cuts, (1.0, end)]
        own = self.edge_parts[(which, number)] = []
        for (t0, first), (t1, last) in pairwise(stops):
            if cuts:
                part = part_of_edge(edge, t0, t1, first, last)
            else:
                part = replace(edge, start=first, end=last)
            shared = self._same_edge(part) if which else None
            if shared is not None:
                own.append(EdgePart(shared[0], t0, t1, shared[1]))
                continue
            own.append(EdgePart(len(self.edges), t0, t1, False))
            if which == 0:
                self._between.setdefault(frozenset((first, last)), []).append(len(self.edges))
            self.edges.append(part)
        if which == 0:
            self._count_first = len(self.edges)

    _count_first = 0

    def _same_edge(self, part: CadEdge) -> tuple[int, bool] | None:
        """The part of the first side that runs together with one of the other, the other way?"""
        for number in self._between.get(frozenset((part.start, part.end)), []):
            edge = self.edges[number]
            reach = self.contacts.same + part.tolerance + edge.tolerance
            points = part.evaluate(QUARTERS, 0)[0]
            near = [nearest_on_edge(edge, point) for point in points]
            if any(distance > reach for _, distance in near):
                continue
            turned = near[0][0] > near[2][0]
            if part.start != part.end:
                turned = edge.start != part.start
            self.edges[number] = replace(edge, tolerance=max(edge.tolerance, part.tolerance))
            return number, turned
        return None

    def _find_lying(self) -> None:
        """The parts of edges that lie in faces of the other side, and not on their borders."""
        sides = self.contacts.sides
        for own, number, other, face in self.contacts.lying:
            which, across = sides.index(own), sides.index(other)
            border = {
                edge_part.edge for coedge in other.whole.patches[face].face.coedges
                for edge_part in self.edge_parts.get((across, coedge.edge), [])
            }  # fmt: skip
            parts = []
            for edge_part in self.edge_parts[(which, number)]:
                if edge_part.edge in border:
                    parts.append(edge_part)
                    continue
                places = self._places_in_face(edge_part.edge, across, other, face)
                if places is not None:
                    self.lying.append(Lying(edge_part.edge, across, face, places))
                    parts.append(edge_part)
            self._require_explained(own, number, other, face, parts)

    def _places_in_face(self, number: int, which: int, other: Side, face: int) -> np.ndarray | None:
        """The places of an edge in a face in which it lies; None where it does not."""
        edge = self.edges[number]
        surface = other.whole.patches[face].face.surface
        uv, distance = nearest_on_surface(surface, edge.evaluate(QUARTERS, 0)[0])
        if not (distance <= self.contacts.same + edge.tolerance).all():
            return None
        if not self.contacts.is_inside(other, face, uv[1]):
            return None
        places = followed(edge, surface, uv[1])
        for node, at in ((edge.start, places[0]), (edge.end, places[-1])):
            point = self.contacts.vertices[node].point
            if self.contacts.edge_there(other, face, point) is None:
                other.add_inner(face, node, at)
        return places

    def _require_explained(
        self, own: Side, number: int, other: Side, face: int, parts: list[EdgePart]
    ) -> None:
        """Raise where an edge seemed to lie on a face and no part of it does, nor touches it in a
        node."""
        for side, edge, across, met, point in self.contacts.unsure:
            if side is not own or edge != number or across is not other or met != face or parts:
                continue
            surface = other.whole.patches[face].face.surface
            uv, distance = nearest_on_surface(surface, point[None])
            if distance[0] > self.contacts.same or not self.contacts.is_inside(other, face, uv[0]):
                continue
            raise SurfaceError(
                f"an edge of {label(own)} comes within {self.contacts.same:.2g} of "
                f"{surface.name or surface.kind} at {place(point)} and neither lies on it nor "
                "crosses it there; move or change one of them"
            )

    def _add_pole(self, which: int, side: Side, number: int, edge: CadEdge) -> None:
        """A degenerate edge, cut where curves and edges leave the pole."""
        node = self.contacts.ends_of(side, edge)[0]
        own = self.edge_parts[(which, number)] = []
        face_number, coedge = next(
            (k, coedge) for k, patch in enumerate(side.whole.patches)
            for coedge in patch.face.coedges if coedge.edge == number
        )  # fmt: skip
        face = side.whole.patches[face_number].face
        leaving: list[tuple[float, np.ndarray | None, np.ndarray | None, int]] = [
            (fraction, None, None, -1)
            for fraction in self._lying_at_pole(which, face_number, coedge, node)
        ]
        other = self.contacts.sides[1 - which]
        for k, inner in enumerate(other.inner):
            for uv in inner.get(node, []):
                across = other.whole.patches[k].face.surface
                normal = unit_normals(across, uv[None])[0]
                same = self.contacts.same
                if contact_at_pole(face.surface, coedge, normal, across, same) != "leaves":
                    self.touched_poles.append((which, face_number, k, node))
                along = self._seam_lies_in(which, side, face, node, 1 - which, k)
                for out in ways_out_of_pole(face.surface, coedge, normal, along):
                    if all(abs(out.fraction - known[0]) > ONE_PLACE for known in leaving):
                        leaving.append((out.fraction, out.way, out.rate, k))
        leaving.sort(key=lambda out: out[0])
        stops = [0.0, *(out[0] for out in leaving), 1.0]
        for k, (t0, t1) in enumerate(pairwise(stops)):
            number_of_part = len(self.edges)
            own.append(EdgePart(number_of_part, t0, t1, False))
            self.edges.append(part_of_edge(edge, t0, t1, node, node))
            if k:  # the place where it starts
                self.leaving[(number_of_part, False)] = leaving[k - 1][1:]
                self.leaving[(number_of_part - 1, True)] = leaving[k - 1][1:]

    def _lying_at_pole(
        self, which: int, face: int, coedge: CadCoedge, node: int
    ) -> Iterator[float]:
        """Fractions of a degenerate edge at which edges that lie in the face come to the pole."""
        for lying in self.lying:
            edge = self.edges[lying.edge]
            if (lying.which, lying.face) != (which, face):
                continue
            for end, uv in ((edge.start, lying.places[0]), (edge.end, lying.places[-1])):
                if end == node:
                    fraction = fraction_at_pole(coedge, uv)
                    if fraction is not None and ONE_PLACE < fraction < 1.0 - ONE_PLACE:
                        yield fraction

    def _seam_lies_in(
        self, which: int, side: Side, face: CadFace, node: int, across: int, other: int
    ) -> bool:
        """Does an edge of a face that comes to a pole lie in a face of the other side?"""
        for coedge in face.coedges:
            for edge_part in self.edge_parts.get((which, coedge.edge), []):
                edge = self.edges[edge_part.edge]
                if edge.degenerate or node not in (edge.start, edge.end):
                    continue
                if any(k.edge == edge_part.edge and (k.which, k.face) == (across, other)
                       for k in self.lying):  # fmt: skip
                    return True
        return False
