"""Two complexes become one: their faces cut each other along common edges.

contacts (nodes)  ->  ends of branches  ->  branches of each pair of faces  ->  new edges
                                                     |
             faces cut into regions  <-  half-edges in each (u, v)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadVertex
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.intersection.arrangement import HalfEdge, half_edge, regions, turn
from surfmesh.intersection.branches import FacePair
from surfmesh.intersection.complex import (
    Complex,
    Patch,
    measured_length,
    part_of_edge,
    with_seams_marked,
)
from surfmesh.intersection.contacts import Contacts, Side
from surfmesh.intersection.contents import region_area
from surfmesh.intersection.curve_fitting import FittedCurve, fitted
from surfmesh.intersection.newton import uv_directions
from surfmesh.intersection.regions import polygon_of
from surfmesh.intersection.tracing import End, Trace, place

GAP = 1e-11
"""Of the diagonal: points so near to both surfaces are on both."""

GRAZING = 1e-5
"""Radians: a curve that comes to an edge at a smaller angle touches it."""

TANGENT = 1e-6
"""Sine of the angle between tangent planes at the end of a curve."""

ROOM = 1e-9
"""Of the box: samples of curves may lie so far outside the box of a new face."""


@dataclass(frozen=True, eq=False)
class Image:
    """A place of a node in the (u, v) of a face. key: among those of the face. leaves, enters:
    (2,) directions of the loop there, None inside the face."""

    key: object
    uv: np.ndarray
    leaves: np.ndarray | None = None
    enters: np.ndarray | None = None


class FaceBorder:
    """The loops of a face with their coedges cut at the nodes."""

    def __init__(self, meeting: Meeting, side: Side, number: int) -> None:
        self.face = side.whole.patches[number].face
        surface = self.face.surface
        box = np.array(surface.domain)
        line = np.linspace(0.0, 1.0, 9)
        grid = np.stack(np.meshgrid(line, line), -1).reshape(-1, 2)
        _, r_u, r_v = surface.evaluate(box[:, 0] + grid * (box[:, 1] - box[:, 0]), 1)
        self.scale = np.array([np.linalg.norm(d, axis=1).mean() for d in (r_u, r_v)])
        self.halves: list[HalfEdge] = []
        self.images: dict[int, list[Image]] = {}
        self.is_cut = False
        for number_of_loop, loop in enumerate(self.face.loops):
            parts = [part for coedge in loop for part in meeting.parts_of(side, coedge)]
            self.is_cut |= len(parts) > len(loop)
            halves = [
                half_edge(
                    coedge, (number_of_loop, k), (number_of_loop, (k + 1) % len(parts)), self.scale
                )
                for k, (coedge, _) in enumerate(parts)
            ]
            for k, (half, (coedge, node)) in enumerate(zip(halves, parts)):
                image = Image(
                    half.start, coedge.walk(np.zeros(1))[0], half.leaves, halves[k - 1].enters
                )
                self.images.setdefault(node, []).append(image)
            self.halves += halves
        for node, places in side.inner[number].items():
            for k, uv in enumerate(places):
                self.images.setdefault(node, []).append(Image((node, k, "inside"), uv))

    def add_curve(
        self, edge: int, pcurve: object, length: float, start: object, end: object
    ) -> None:
        """Both half-edges of a curve between two places."""
        forward = CadCoedge(edge, False, pcurve, 0.0, length, False)  # type: ignore[arg-type]
        backward = replace(forward, reversed=True)
        self.halves.append(half_edge(forward, start, end, self.scale))
        self.halves.append(half_edge(backward, end, start, self.scale))
        self.is_cut = True

    def enters(self, image: Image, way: np.ndarray) -> bool:
        """Does a direction (2,) lead from a place into the face? Raises where it runs along its
        border."""
        if image.leaves is None or image.enters is None:
            return True
        way = way * self.scale
        open_angle = turn(image.leaves, -image.enters) or 2.0 * np.pi
        angle = turn(image.leaves, way)
        for edge in (0.0, open_angle, 2.0 * np.pi):
            if abs(angle - edge) < GRAZING:
                where = place(self.face.surface.evaluate(image.uv[None], 0)[0][0])
                raise SurfaceError(
                    f"{self.face.surface.name}: a curve touches its edge at {where}; move or "
                    "change one of the surfaces"
                )
        return angle < open_angle


class Meeting:
    """Of two complexes. size: the diagonal of all."""

    def __init__(self, p: Complex, q: Complex, size: float) -> None:
        self.size = size
        self.contacts = Contacts(p, q, size)
        self.edges: list[CadEdge] = []
        self.pieces: dict[tuple[int, int], list[tuple[int, float, float]]] = {}
        for which, side in enumerate(self.contacts.sides):
            for number, edge in enumerate(side.whole.edges):
                self._add_pieces(which, side, number, edge)
        self.borders = [
            [FaceBorder(self, side, k) for k in range(len(side.whole.patches))]
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
        cuts = sorted((t, node) for node, t in side.cuts[number].items())
        stops = [(0.0, start), *cuts, (1.0, end)]
        own = self.pieces[(which, number)] = []
        for (t0, first), (t1, last) in pairwise(stops):
            own.append((len(self.edges), t0, t1))
            if cuts:
                self.edges.append(part_of_edge(edge, t0, t1, first, last))
            else:
                self.edges.append(replace(edge, start=first, end=last))

    def parts_of(self, side: Side, coedge: CadCoedge) -> list[tuple[CadCoedge, int]]:
        """A coedge cut at the nodes, in walking order; with the node where each part starts."""
        which = self.contacts.sides.index(side)
        found = []
        for edge, t0, t1 in self.pieces[(which, coedge.edge)]:
            p0, p1 = coedge.p0 + np.array([t0, t1]) * (coedge.p1 - coedge.p0)
            part = replace(coedge, edge=edge, p0=float(p0), p1=float(p1))
            made = self.edges[edge]
            found.append((part, made.end if coedge.reversed else made.start))
        return found[::-1] if coedge.reversed else found

    def _pair(self, i: int, j: int) -> None:
        """All curves in which face i of the one and face j of the other meet."""
        one, other = self.contacts.sides
        a, b = self.borders[0][i], self.borders[1][j]
        pair = FacePair(
            a.face, b.face, (one.cells[i], other.cells[j]), (one.regions[i], other.regions[j]),
            self.size, GAP * self.size,
        )  # fmt: skip
        ends = [end for node in a.images.keys() & b.images.keys() for end in self._ends(node, a, b)]
        for trace in pair.all_branches(ends):
            made = fitted(trace, a.face.surface, b.face.surface, self.size)
            self._add_curve(trace, made, a, b)

    def _ends(self, node: int, a: FaceBorder, b: FaceBorder) -> list[End]:
        """Where branches of a pair of faces start in a node, each with its way into both."""
        found = []
        point = self.contacts.vertices[node].point
        for one in a.images[node]:
            for other in b.images[node]:
                way, sine = _tangent(a.face.surface, b.face.surface, one.uv, other.uv)
                if sine < TANGENT:
                    raise SurfaceError(
                        f"{a.face.surface.name} and {b.face.surface.name} have one tangent plane "
                        f"at {place(point)}: such contacts are not intersected; move one of them"
                    )
                for sign in (1.0, -1.0):
                    along_a, along_b = (
                        uv_directions(border.face.surface, image.uv[None], sign * way[None])[0]
                        for border, image in ((a, one), (b, other))
                    )
                    if a.enters(one, along_a) and b.enters(other, along_b):
                        found.append(
                            End(node, one.uv, other.uv, point, sign * way, one.key, other.key)
                        )
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
    ones = np.ones(2)
    corners = np.concatenate([polygon_of(c, ones)[0] for loop in loops for c in loop])
    low, high = corners.min(axis=0), corners.max(axis=0)
    room = ROOM * (high - low)
    box = ((low - room)[0], (high + room)[0]), ((low - room)[1], (high + room)[1])
    surface = face.surface.with_domain(box)
    marked = with_seams_marked(loops)
    return replace(face, surface=surface, loops=marked, area=region_area(surface, marked))


def _tangent(
    a: FaceSurface, b: FaceSurface, uv_a: np.ndarray, uv_b: np.ndarray
) -> tuple[np.ndarray, float]:
    normals = []
    for surface, uv in ((a, uv_a), (b, uv_b)):
        _, r_u, r_v = surface.evaluate(uv[None], 1)
        normal = np.cross(r_u[0], r_v[0])
        normals.append(normal / max(float(np.linalg.norm(normal)), 1e-300))
    cross = np.cross(normals[0], normals[1])
    sine = float(np.linalg.norm(cross))
    return cross / max(sine, 1e-300), sine


def joined(complexes: Sequence[Complex], size: float) -> Complex:
    """All complexes cut by each other, one after the other: so three faces through a point have
    it as a vertex, as the third cuts the edge of the first two there."""
    whole = complexes[0]
    for other in complexes[1:]:
        whole = Meeting(whole, other, size).joined()
    return whole
