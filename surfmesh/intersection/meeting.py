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

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadVertex
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import norm
from surfmesh.intersection.arrangement import regions
from surfmesh.intersection.borders import FaceBorder, Image
from surfmesh.intersection.branches import FacePair
from surfmesh.intersection.complex import Complex, Patch, measured_length, with_seams_marked
from surfmesh.intersection.contact_curves import pulled_into_contact
from surfmesh.intersection.contacts import Contacts
from surfmesh.intersection.curve_fitting import FittedCurve, fitted
from surfmesh.intersection.edge_parts import EdgeParts, Lying
from surfmesh.intersection.elementary_distances import are_one_surface
from surfmesh.intersection.newton import Pulled, pulled_onto_both, unit_normals, uv_directions
from surfmesh.intersection.overlaps import Overlaps
from surfmesh.intersection.pcurve_fitting import pcurve_along
from surfmesh.intersection.regions import polygon_of
from surfmesh.intersection.touching import branch_ways
from surfmesh.intersection.tracing import End, Trace, place

GAP = 1e-11
"""Of the diagonal: points so near to both surfaces are on both."""

TANGENT = 1e-5
"""Sine of the angle between planes that are taken for one."""

LOOSEST = 1e-6
"""Of the diagonal: so near a curve must follow an edge that lies on a face."""

KNOWN = 257
"""Places of a common edge that is known before."""

PROBED = 1e-3
"""Of the smaller face: how far ahead it is looked whether a curve leads into both."""

ROOM = 1e-9
"""Of the box: samples of curves may lie so far outside the box of a new face."""


class Meeting:
    """Of two complexes. size: the diagonal of all; merge: what coincides becomes one patch."""

    def __init__(self, p: Complex, q: Complex, size: float, merge: bool) -> None:
        self.size, self.merge = size, merge
        self.contacts = Contacts(p, q, size)
        self.parts = EdgeParts(self.contacts)
        self.edges = self.parts.edges
        self.remarks: list[str] = []
        """Sentences on contacts that leave both as they are."""
        self.coincident: list[tuple[int, int]] = []
        """Faces of the one and the other side on one surface."""
        self.borders = [
            [
                FaceBorder(
                    patch.face, side.inner[k], partial(self.parts.parts_of, side, patch.face),
                    partial(self.contacts.is_inside, side, k),
                )
                for k, patch in enumerate(side.whole.patches)
            ]
            for side in self.contacts.sides
        ]  # fmt: skip
        for lying in self.parts.lying:
            self._embed(lying)
        one, other = self.contacts.sides
        for i in range(len(one.whole.patches)):
            for j in other.faces_near(one.boxes, i):
                self._pair(i, j)

    def joined(self) -> Complex:
        """Both complexes, cut along their common edges."""
        first, second = (
            [self._parts(patch, border) for patch, border in zip(side.whole.patches, borders)]
            for side, borders in zip(self.contacts.sides, self.borders)
        )
        overlap = Overlaps(self.contacts, self.edges, self.coincident, self.merge)
        patches = overlap.joined(first, second)
        return Complex(self.contacts.vertices, self.edges, patches)

    def _embed(self, lying: Lying) -> None:
        """An edge of the one side becomes a curve on a face of the other in which it lies."""
        border = self.borders[lying.which][lying.face]
        edge, places = self.edges[lying.edge], lying.places.copy()
        keys = []
        for node, k in ((edge.start, 0), (edge.end, -1)):
            image = border.image_at(node, places[k])
            places[k] = image.uv
            keys.append(image.key)
        surface = border.face.surface
        curve, length, off = pcurve_along(edge, surface, places, GAP * self.size)
        if off > edge.tolerance:
            if off > LOOSEST * self.size:
                raise SurfaceError(
                    f"{surface.name}: no curve follows an edge that lies on it, near "
                    f"{place(edge.evaluate(np.array([0.5]))[0][0])}: the best is {off:.2g} off"
                )
            self.edges[lying.edge] = replace(edge, tolerance=1.1 * off)
        border.add_curve(lying.edge, curve, length, *keys)

    def _pair(self, i: int, j: int) -> None:
        """All curves in which face i of the one and face j of the other meet."""
        one, other = self.contacts.sides
        a, b = self.borders[0][i], self.borders[1][j]
        if are_one_surface(a.face.surface, b.face.surface, self.contacts.same):
            self.coincident.append((i, j))
            return
        pair = FacePair(
            a.face, b.face, (one.cells[i], other.cells[j]), (one.regions[i], other.regions[j]),
            self.size, GAP * self.size,
        )  # fmt: skip
        pair.known = [trace for edge in a.shared_with(b) for trace in self._known(edge, a, b)]
        pair.singular = self._poles(a, j) + self._poles(b, i)
        pair.singular += [
            self.contacts.vertices[node].point
            for which, face, across, node in self.parts.touched_poles
            if (face, across) == ((i, j), (j, i))[which]
        ]
        nodes = sorted(a.images.keys() & b.images.keys())
        ends = [end for node in nodes for end in self._ends(pair, node, a, b, i, j)]
        for trace in pair.contacts_from(ends):
            self._add_contact(pair, trace, a, b)
        for what, found in pair.tangencies():
            if what == "along":
                self._add_contact(pair, pair.closed_contact(found), a, b)
                continue
            pair.singular.append(found.point)
            if what == "cross" and pair.are_in_both(found):
                node = self._add_branch_point(found, a, b)
                if node not in nodes:
                    ends += self._ends(pair, node, a, b, i, j)
            elif what == "touch" and pair.are_in_both(found):
                self.remarks.append(
                    f"{a.face.surface.name} and {b.face.surface.name} touch at "
                    f"{place(found.point)}, where nothing is cut"
                )
        if pair.is_one_surface:
            self.coincident.append((i, j))
            return
        pair.singular += [end.point for end in ends if end.singular]
        for trace in pair.all_branches(ends):
            made = fitted(trace, a.face.surface, b.face.surface, self.size)
            self._add_curve(trace, made, a, b)

    def _add_contact(self, pair: FacePair, trace: Trace, a: FaceBorder, b: FaceBorder) -> None:
        """A curve along which two faces touch."""
        number = len(self.edges)
        made = fitted(trace, a.face.surface, b.face.surface, self.size)
        self._add_curve(trace, made, a, b)
        pair.known += self._known(number, a, b)

    def _known(self, number: int, a: FaceBorder, b: FaceBorder) -> list[Trace]:
        """An edge that both faces have, as a trace on both."""
        edge = self.edges[number]
        fraction = np.linspace(0.0, 1.0, KNOWN)
        points = edge.evaluate(fraction, 0)[0]
        traces = []
        for one in a.uses(number):
            for other in b.uses(number):
                uv_a, uv_b = one.uv(fraction), other.uv(fraction)
                cross = np.cross(
                    unit_normals(a.face.surface, uv_a), unit_normals(b.face.surface, uv_b)
                )
                touches = bool(np.linalg.norm(cross, axis=1)[1:-1].max() <= TANGENT)
                traces.append(Trace(points, uv_a, uv_b, None, None, touches))
        return traces

    def _poles(self, border: FaceBorder, other: int) -> list[np.ndarray]:
        """Poles of a face through which another face of the other side passes."""
        return [
            self.contacts.vertices[node].point
            for node, images in border.images.items()
            if any(image.other == other and image.way is not None for image in images)
        ]

    def _add_branch_point(self, found: Pulled, a: FaceBorder, b: FaceBorder) -> int:
        """The node where curves of two faces cross, a new one unless there is one."""
        node = self.contacts.node_at(found.point)
        for border, uv in ((a, found.uv_a), (b, found.uv_b)):
            if node not in border.images:
                border.images[node] = [Image((node, 0, "inside"), uv)]
        return node

    def _ends(
        self, pair: FacePair, node: int, a: FaceBorder, b: FaceBorder, i: int, j: int
    ) -> list[End]:
        """Where branches of a pair of faces start in a node, each with its way into both."""
        found = []
        point = self.contacts.vertices[node].point
        for one in a.images[node]:
            for other in b.images[node]:
                if one.is_pole or other.is_pole:
                    what, ways = "pole", _ways_at_pole(one, other, i, j)
                else:
                    what, ways = _ways(a.face.surface, b.face.surface, one.uv, other.uv)
                if what in ("touch", "along", "flat"):
                    pair.singular.append(point)
                for way in ways:
                    end = End(
                        node, one.uv, other.uv, point, way, one.key, other.key,
                        what in ("pole", "cross"), one.rate, other.rate, what == "along",
                    )  # fmt: skip
                    if self._leads_into_both(end, a, b, one, other):
                        found.append(end)
        return found

    def _leads_into_both(
        self, end: End, a: FaceBorder, b: FaceBorder, one: Image, other: Image
    ) -> bool:
        """Does a way out of a node lead into both faces, and along no edge that both have?"""
        along_a, along_b = (
            uv_directions(border.face.surface, image.uv[None], end.way[None])[0]
            if image.rate is None else image.rate
            for border, image in ((a, one), (b, other))
        )  # fmt: skip
        if a.edges_along(one, along_a) & b.edges_along(other, along_b):
            return False
        step = PROBED * min(a.extent, b.extent)
        pulled = pulled_into_contact if end.touches else pulled_onto_both
        ahead = pulled(
            a.face.surface, b.face.surface, (one.uv + step * along_a)[None],
            (other.uv + step * along_b)[None], end.way[None], (end.point + step * end.way)[None],
        )  # fmt: skip
        uv_a, uv_b = ahead.uv_a[0], ahead.uv_b[0]
        if not ahead.gap[0] <= GAP * self.size:
            uv_a, uv_b = one.uv + step * along_a, other.uv + step * along_b
        return a.enters(one, along_a, uv_a) and b.enters(other, along_b, uv_b)

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

    @staticmethod
    def _parts(patch: Patch, border: FaceBorder) -> list[Patch]:
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
    a: FaceSurface, b: FaceSurface, uv_a: np.ndarray, uv_b: np.ndarray
) -> tuple[str, list[np.ndarray]]:
    """The directions (3,) of common curves in a common point: where the surfaces are "transversal",
    else as of ``branch_ways``."""
    cross = np.cross(unit_normals(a, uv_a[None])[0], unit_normals(b, uv_b[None])[0])
    sine = norm(cross)
    if sine >= TANGENT:
        return "transversal", [cross / sine, -cross / sine]
    return branch_ways(a, b, uv_a, uv_b)


def _ways_at_pole(one: Image, other: Image, i: int, j: int) -> list[np.ndarray]:
    """The way that leaves a pole of one face, where it is common with the other."""
    if one.way is not None and one.other == j and not other.is_pole:
        return [one.way]
    if other.way is not None and other.other == i and not one.is_pole:
        return [other.way]
    return []


def joined(
    complexes: Sequence[Complex], size: float, merge: bool
) -> tuple[Complex, tuple[str, ...]]:
    """All complexes cut by each other, one after the other: so three faces through a point have
    it as a vertex, as the third cuts the edge of the first two there. merge: what coincides
    becomes one patch, else it is refused. With sentences on contacts that leave all as it is."""
    whole, remarks = complexes[0], []
    for other in complexes[1:]:
        meeting = Meeting(whole, other, size, merge)
        whole = meeting.joined()
        remarks += meeting.remarks
    return whole, tuple(dict.fromkeys(remarks))
