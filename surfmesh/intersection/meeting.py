"""Two complexes become one: their faces cut each other along common edges.

contacts (nodes)  ->  ends of branches  ->  branches of each pair of faces  ->  new edges
                                                     |
             faces cut into regions  <-  half-edges in each (u, v)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadVertex
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.intersection.arrangement import regions
from surfmesh.intersection.borders import FaceBorder, Image, Part
from surfmesh.intersection.branches import FacePair
from surfmesh.intersection.complex import (
    Complex,
    Patch,
    measured_length,
    part_of_edge,
    with_seams_marked,
)
from surfmesh.intersection.contacts import Contacts, Side
from surfmesh.intersection.curve_fitting import FittedCurve, fitted
from surfmesh.intersection.newton import unit_normals, uv_directions
from surfmesh.intersection.poles import ways_out_of_pole
from surfmesh.intersection.regions import polygon_of
from surfmesh.intersection.touching import Touch, branch_ways
from surfmesh.intersection.tracing import End, Trace, place

GAP = 1e-11
"""Of the diagonal: points so near to both surfaces are on both."""

TANGENT = 1e-5
"""Sine of the angle between planes that are taken for one."""

ROOM = 1e-9
"""Of the box: samples of curves may lie so far outside the box of a new face."""


class Meeting:
    """Of two complexes. size: the diagonal of all."""

    def __init__(self, p: Complex, q: Complex, size: float) -> None:
        self.size = size
        self.contacts = Contacts(p, q, size)
        self.edges: list[CadEdge] = []
        self.pieces: dict[tuple[int, int], list[tuple[int, float, float]]] = {}
        self.leaving: dict[tuple[int, bool], tuple[np.ndarray, np.ndarray, int]] = {}
        """Where a part of a degenerate edge starts, or starts when walked backwards, the curve
        that leaves the pole: its way (3,), its rate (2,) in (u, v), the face it is common with."""
        for which, side in enumerate(self.contacts.sides):
            for number, edge in enumerate(side.whole.edges):
                self._add_pieces(which, side, number, edge)
        self.borders = [
            [
                FaceBorder(patch.face, side.inner[k], partial(self.parts_of, side))
                for k, patch in enumerate(side.whole.patches)
            ]
            for side in self.contacts.sides
        ]
        one, other = self.contacts.sides
        for i in range(len(one.whole.patches)):
            for j in other.faces_near(one.boxes, i):
                self._pair(i, j)

    def joined(self) -> Complex:
        """Both complexes, cut along their common edges."""
        patches = [
            part
            for side, borders in zip(self.contacts.sides, self.borders)
            for patch, border in zip(side.whole.patches, borders)
            for part in self._parts(patch, border)
        ]
        return Complex(self.contacts.vertices, self.edges, patches)

    def _add_pieces(self, which: int, side: Side, number: int, edge: CadEdge) -> None:
        start, end = self.contacts.ends_of(side, edge)
        if edge.degenerate:
            self._add_pole(which, side, number, edge, start)
            return
        cuts = sorted((t, node) for node, t in side.cuts[number].items())
        stops = [(0.0, start), *cuts, (1.0, end)]
        own = self.pieces[(which, number)] = []
        for (t0, first), (t1, last) in pairwise(stops):
            own.append((len(self.edges), t0, t1))
            if cuts:
                self.edges.append(part_of_edge(edge, t0, t1, first, last))
            else:
                self.edges.append(replace(edge, start=first, end=last))

    def _add_pole(self, which: int, side: Side, number: int, edge: CadEdge, node: int) -> None:
        """A degenerate edge, cut where curves leave the pole."""
        own = self.pieces[(which, number)] = []
        leaving = []
        other = self.contacts.sides[1 - which]
        face, coedge = next(
            (patch.face, coedge) for patch in side.whole.patches for coedge in patch.face.coedges
            if coedge.edge == number
        )  # fmt: skip
        for k, inner in enumerate(other.inner):
            for uv in inner.get(node, []):
                normal = unit_normals(other.whole.patches[k].face.surface, uv[None])[0]
                leaving += [
                    (out.fraction, out.way, out.rate, k)
                    for out in ways_out_of_pole(face.surface, coedge, normal)
                ]
        leaving.sort(key=lambda out: out[0])
        stops = [0.0, *(out[0] for out in leaving), 1.0]
        for k, (t0, t1) in enumerate(pairwise(stops)):
            piece = len(self.edges)
            own.append((piece, t0, t1))
            self.edges.append(part_of_edge(edge, t0, t1, node, node))
            if k:  # the place where it starts
                self.leaving[(piece, False)] = leaving[k - 1][1:]
                self.leaving[(piece - 1, True)] = leaving[k - 1][1:]

    def parts_of(self, side: Side, coedge: CadCoedge) -> list[Part]:
        """A coedge cut at the nodes, in walking order."""
        which = self.contacts.sides.index(side)
        found = []
        for edge, t0, t1 in self.pieces[(which, coedge.edge)]:
            p0, p1 = coedge.p0 + np.array([t0, t1]) * (coedge.p1 - coedge.p0)
            part = replace(coedge, edge=edge, p0=float(p0), p1=float(p1))
            made = self.edges[edge]
            leaving = self.leaving.get((edge, coedge.reversed), (None, None, -1))
            node = made.end if coedge.reversed else made.start
            found.append(Part(part, node, made.degenerate, leaving))
        return found[::-1] if coedge.reversed else found

    def _pair(self, i: int, j: int) -> None:
        """All curves in which face i of the one and face j of the other meet."""
        one, other = self.contacts.sides
        a, b = self.borders[0][i], self.borders[1][j]
        pair = FacePair(
            a.face, b.face, (one.cells[i], other.cells[j]), (one.regions[i], other.regions[j]),
            self.size, GAP * self.size,
        )  # fmt: skip
        pair.singular = self._poles(a, j) + self._poles(b, i)
        for touch in pair.branch_points():
            self._add_branch_point(touch, a, b)
        nodes = sorted(a.images.keys() & b.images.keys())
        ends = [end for node in nodes for end in self._ends(node, a, b, i, j)]
        pair.singular += [end.point for end in ends if end.singular]
        for trace in pair.all_branches(ends):
            made = fitted(trace, a.face.surface, b.face.surface, self.size)
            self._add_curve(trace, made, a, b)

    def _poles(self, border: FaceBorder, other: int) -> list[np.ndarray]:
        """Poles of a face through which another face of the other side passes."""
        return [
            self.contacts.vertices[node].point
            for node, images in border.images.items()
            if any(image.other == other and image.way is not None for image in images)
        ]

    def _add_branch_point(self, touch: Touch, a: FaceBorder, b: FaceBorder) -> None:
        """A node where two faces touch, unless there is one."""
        node = self.contacts.node_at(touch.point)
        for border, uv in ((a, touch.place[:2]), (b, touch.place[2:])):
            if node not in border.images:
                border.images[node] = [Image((node, 0, "inside"), uv)]

    def _ends(self, node: int, a: FaceBorder, b: FaceBorder, i: int, j: int) -> list[End]:
        """Where branches of a pair of faces start in a node, each with its way into both."""
        found = []
        point = self.contacts.vertices[node].point
        for one in a.images[node]:
            for other in b.images[node]:
                if one.is_pole or other.is_pole:
                    ways, singular = _ways_at_pole(one, other, i, j), True
                else:
                    ways, singular = _ways(a.face.surface, b.face.surface, one.uv, other.uv, point)
                for way in ways:
                    along_a, along_b = (
                        uv_directions(border.face.surface, image.uv[None], way[None])[0]
                        if image.rate is None else image.rate
                        for border, image in ((a, one), (b, other))
                    )  # fmt: skip
                    if a.enters(one, along_a) and b.enters(other, along_b):
                        found.append(
                            End(
                                node, one.uv, other.uv, point, way, one.key, other.key, singular,
                                one.rate, other.rate,
                            )
                        )  # fmt: skip
        return found

    def _add_curve(self, trace: Trace, made: FittedCurve, a: FaceBorder, b: FaceBorder) -> None:
        number = len(self.edges)
        if trace.start is None or trace.end is None:
            start = end = len(self.contacts.vertices)
            self.contacts.vertices.append(CadVertex(trace.points[0], GAP * self.size))
            self.contacts.node_of.append(start)
            keys_a = keys_b = ((start, 0, "inside"),) * 2
        else:
            start, end = trace.start.node, trace.end.node
            keys_a = trace.start.image_a, trace.end.image_a  # type: ignore[assignment]
            keys_b = trace.start.image_b, trace.end.image_b  # type: ignore[assignment]
        names = [border.face.name or border.face.kind for border in (a, b)]
        edge = CadEdge(
            curve=made.curve, t0=0.0, t1=made.length, start=start, end=end,
            tolerance=max(2.0 * made.deviation, GAP * self.size), degenerate=False,
            name="/".join(names), length=made.length,
        )  # fmt: skip
        self.edges.append(replace(edge, length=measured_length(edge)))
        a.add_curve(number, made.pcurve_a, made.length, *keys_a)
        b.add_curve(number, made.pcurve_b, made.length, *keys_b)

    def _parts(self, patch: Patch, border: FaceBorder) -> list[Patch]:
        if not border.is_cut:  # its edges have new numbers
            coedges = iter(border.halves)
            loops = [[next(coedges).coedge for _ in loop] for loop in patch.face.loops]
            face = replace(patch.face, loops=with_seams_marked(loops))
            return [replace(patch, face=face)]
        found = regions(patch.face, border.halves)
        return [replace(patch, face=_part_of_face(patch.face, loops)) for loops in found]


def _part_of_face(face: CadFace, loops: Sequence[tuple[CadCoedge, ...]]) -> CadFace:
    polygons = [polygon_of(c, np.ones(2)) for loop in loops for c in loop]
    corners = np.concatenate([polygon for polygon, _ in polygons])
    low, high = corners.min(axis=0), corners.max(axis=0)
    # between its samples a curve may go out further
    room = ROOM * (high - low) + 2.0 * max(float(sag.max()) for _, sag in polygons)
    box = ((low - room)[0], (high + room)[0]), ((low - room)[1], (high + room)[1])
    surface = face.surface.with_domain(box)
    marked = with_seams_marked(loops)
    return replace(face, surface=surface, loops=marked, area=math.nan)  # see ``with_areas``


def _ways(
    a: FaceSurface, b: FaceSurface, uv_a: np.ndarray, uv_b: np.ndarray, point: np.ndarray
) -> tuple[list[np.ndarray], bool]:
    """The directions (3,) of common curves in a common point; is it a branch point?"""
    cross = np.cross(unit_normals(a, uv_a[None])[0], unit_normals(b, uv_b[None])[0])
    sine = float(np.linalg.norm(cross))
    if sine >= TANGENT:
        return [cross / sine, -cross / sine], False
    what, ways = branch_ways(a, b, uv_a, uv_b)
    if what == "cross":
        return ways, True
    raise SurfaceError(
        f"{a.name} and {b.name} touch {'along a curve through' if what == 'along' else 'at'} "
        f"{place(point)}: such contacts are not intersected; move or change one of them"
    )


def _ways_at_pole(one: Image, other: Image, i: int, j: int) -> list[np.ndarray]:
    """The way that leaves a pole of one face, where it is common with the other."""
    if one.way is not None and one.other == j and not other.is_pole:
        return [one.way]
    if other.way is not None and other.other == i and not one.is_pole:
        return [other.way]
    return []


def joined(complexes: Sequence[Complex], size: float) -> Complex:
    """All complexes cut by each other, one after the other: so three faces through a point have
    it as a vertex, as the third cuts the edge of the first two there."""
    whole = complexes[0]
    for other in complexes[1:]:
        whole = Meeting(whole, other, size).joined()
    return whole
