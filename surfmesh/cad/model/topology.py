"""From OCP's shapes to a `CadModel`: every vertex, edge and face once, by number.

Shapes are the same when TShape and location are (``IsSame``); orientation is kept where a shape
is used: in the coedges of a face and in the shells of a solid.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path as FilePath

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepGProp import BRepGProp
from OCP.BRepTools import BRepTools
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.GProp import GProp_GProps
from OCP.Precision import Precision
from OCP.ShapeFix import ShapeFix_Edge
from OCP.TopAbs import (
    TopAbs_EDGE,
    TopAbs_EXTERNAL,
    TopAbs_FACE,
    TopAbs_FORWARD,
    TopAbs_INTERNAL,
    TopAbs_REVERSED,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_VERTEX,
    TopAbs_WIRE,
)
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Iterator, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from surfmesh.cad.assembly import Detail, Part
from surfmesh.cad.healing.unusable_faces import face_in_words
from surfmesh.cad.model.cad_model import (
    CadCoedge,
    CadEdge,
    CadFace,
    CadModel,
    CadNode,
    CadSolid,
    CadTag,
    CadVertex,
    Colour,
    Shell,
)
from surfmesh.cad.model.convert import curve2d_of, curve_of, surface_of
from surfmesh.cad.model.extent import diagonal
from surfmesh.cad.model.invariants import is_closed, signed_area
from surfmesh.cad.model.loop_faults import fault_of_pieces
from surfmesh.cad.model.loops import chained, misdirected, outer_first, there_and_back, turned
from surfmesh.cad.model.near_poles import pcurves_at_near_poles
from surfmesh.cad.model.points_inside import short_edges, vertices_inside
from surfmesh.cad.model.singular_cuts import cut_at_singular_lines
from surfmesh.cad.model.tolerances import (
    curves_on_their_faces,
    joined,
    listed,
    pcurves_that_follow,
    tolerances_that_hold,
)
from surfmesh.cad.reading.contents_of_file import unread_bodies, without_faces
from surfmesh.cad.sub_shapes import each
from surfmesh.errors import CadError, SurfmeshError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.surface import Domain

# relative error of areas and volumes by adaptive integration, which is slow on splines
EXACT = 1e-8
EXACT_FREE_FORM = 1e-6
ELEMENTARY = {"plane", "cylinder", "cone", "sphere", "torus"}
TINY = 1e-14  # of its distance from the origin: a (u, v) box so narrow is a line


def cad_model(
    root: Part, *, heal: bool = True, unit: str = "mm", file_unit: str = "mm", source: str = "",
    path: FilePath | None = None,
) -> CadModel:  # fmt: skip
    """The plain data of a tree of parts that are healed and in place.

    heal: also replace p-curves that stray from their edges. path: of the file it was read from.

    Faces that cannot be used are left out, and listed. Raises CadError when there is no other.
    """
    walk = _Walk(heal)
    tree = walk.part(root, None)
    if not walk.faces:
        called = source or root.name or "the model"
        raise CadError(without_faces(called, root, path, walk.left_out))
    if path is not None:
        walk.left_out += unread_bodies(path)
    healing = _in_words(walk, root)
    if heal:
        healing += pcurves_that_follow(walk.edges, walk.vertices, walk.faces, unit)
        healing += pcurves_at_near_poles(walk.edges, walk.vertices, walk.faces)
        healing += curves_on_their_faces(walk.edges, walk.vertices, walk.faces, unit)
    healing += tolerances_that_hold(walk.edges, walk.vertices, walk.faces, unit)
    _fault_split_faces(walk, root)
    model = CadModel(
        vertices=tuple(walk.vertices),
        edges=tuple(walk.edges),
        faces=tuple(walk.faces),
        solids=tuple(walk.solids),
        free_shells=tuple(walk.free_shells),
        free_faces=tuple(walk.free_faces),
        name=root.name,
        unit=unit,
        file_unit=file_unit,
        diagonal=diagonal(walk.vertices, walk.edges, walk.faces),
        tree=tree,
        healing=tuple(healing + walk.remarks() + _touching(walk.faces, walk.solids)),
        source=source,
        tags=walk.tags(root),
        left_out=tuple(walk.left_out),
    )
    return cut_at_singular_lines(model)


_TAGGED = {
    TopAbs_SOLID: ("solids", TopAbs_SOLID), TopAbs_WIRE: ("edges", TopAbs_EDGE),
    TopAbs_EDGE: ("edges", TopAbs_EDGE), TopAbs_VERTEX: ("vertices", TopAbs_VERTEX),
}  # fmt: skip
"""Kinds of what a tag stands for; all others are made of faces."""


def _is_of_ocp(error: Exception) -> bool:
    """OCP's own exceptions have no common parent in Python."""
    return type(error).__module__.split(".")[0] == "OCP"


def _in_one_line(error: Exception) -> str:
    """What is wrong, without the number of the face, which another one has by now."""
    said = " ".join(str(error).split())
    if _is_of_ocp(error):
        return f"OCP gave up: {type(error).__name__} {said}"
    return re.sub(r"^face \d+( \(.*?\))?(: |, | )", "", said)


class _Numbering:
    """Shapes by number in the order in which they are met."""

    def __init__(self) -> None:
        self._map = TopTools_IndexedMapOfShape()

    def find(self, shape: TopoDS_Shape) -> int | None:
        number = self._map.FindIndex(shape)
        return number - 1 if number else None

    def add(self, shape: TopoDS_Shape) -> int:
        return self._map.Add(shape) - 1

    def __len__(self) -> int:
        return self._map.Extent()

    def forget_after(self, count: int) -> None:
        """Only the first ``count`` shapes have been met."""
        while self._map.Extent() > count:
            self._map.RemoveLast()


class _Walk:
    """What has been met so far on the way through the parts."""

    def __init__(self, heal: bool) -> None:
        self.heal = heal
        self.vertices: list[CadVertex] = []
        self.edges: list[CadEdge] = []
        self.faces: list[CadFace] = []
        self.solids: list[CadSolid] = []
        self.free_shells: list[Shell] = []
        self.free_faces: list[int] = []
        self._vertex_numbers = _Numbering()
        self._vertices_met: list[int] = []  # a closed edge may have a vertex of its own besides
        self._edge_numbers = _Numbering()
        self._face_numbers = _Numbering()
        self._solid_numbers = _Numbering()
        self._detail_numbers = _Numbering()
        self._details: list[Detail] = []
        self._remarks: Counter[str] = Counter()
        self.left_out: list[str] = []
        self._unusable = _Numbering()
        self._part = Part("")  # that is walked through

    def part(self, part: Part, colour: Colour | None) -> CadNode:
        """Take in a part and all below it; colour: what it inherits."""
        colour = part.colour or colour
        solids: list[int] = []
        faces: list[int] = []
        self.left_out += part.left_out
        if part.shape is not None:
            self._part = part
            for detail in part.details:
                if self._detail_numbers.find(detail.shape) is None:
                    self._detail_numbers.add(detail.shape)
                    self._details.append(detail)
            found = [self.solid(s, part, colour) for s in each(part.shape, TopAbs_SOLID)]
            solids = [number for number in found if number is not None]
            for shape in each(part.shape, TopAbs_SHELL, TopAbs_SOLID):
                shell = self.shell(shape, self.detail(shape)[1] or colour)
                if shell:
                    self.free_shells.append(shell)
                    faces += [face for face, _ in shell]
            held = self.held_by_shells()
            for shape in each(part.shape, TopAbs_FACE, TopAbs_SHELL):
                number = self.face(shape, colour)
                if number is None:
                    continue
                if number not in held and number not in self.free_faces:
                    self.free_faces.append(number)
                faces.append(number)
        children = tuple(self.part(child, colour) for child in part.children)
        return CadNode(part.name, tuple(dict.fromkeys(solids)), tuple(faces), children)

    def held_by_shells(self) -> set[int]:
        """Numbers of the faces of all solids and shells so far."""
        shells = [shell for solid in self.solids for shell in solid.shells] + self.free_shells
        return {face for shell in shells for face, _ in shell}

    def detail(self, shape: TopoDS_Shape) -> tuple[str, Colour | None]:
        """Name and colour of a shape within its part."""
        number = self._detail_numbers.find(shape)
        return ("", None) if number is None else self._details[number][1:3]

    def names(self, shape: TopoDS_Shape) -> tuple[str, ...]:
        """All names of a shape that was made of several; else none."""
        number = self._detail_numbers.find(shape)
        return () if number is None else self._details[number].names

    def solid(self, shape: TopoDS_Shape, part: Part, colour: Colour | None) -> int | None:
        """Number of a solid, taken in when it is met first; None for one without faces."""
        known = self._solid_numbers.find(shape)
        if known is not None:
            return known
        name, own = self.detail(shape)
        colour = own or colour
        shells = [self.shell(s, self.detail(s)[1] or colour) for s in each(shape, TopAbs_SHELL)]
        shells = [shell for shell in shells if shell]
        if not shells:
            self._remarks["a solid without faces is left out"] += 1
            return None
        kinds = [self.faces[face].kind for shell in shells for face, _ in shell]
        volume = _volume(shape, kinds)
        if volume < 0.0:
            self._remarks[f"solid {len(self.solids)} was inside out: its faces are turned"] += 1
            shells = [tuple((face, not against) for face, against in shell) for shell in shells]
        self._solid_numbers.add(shape)
        shells = tuple(sorted(shells, key=self._extent, reverse=True))
        self.solids.append(
            CadSolid(
                shells=shells,
                name=name or part.name,
                colour=colour,
                volume=abs(volume),
                closed=is_closed(self.faces, shells, self.edges),
                names=self.names(shape),
            )
        )
        return len(self.solids) - 1

    def _extent(self, shell: Shell) -> float:
        """Diagonal of the box of a shell's vertices: the outer shell has the largest."""
        numbers = {
            vertex
            for face, _ in shell
            for coedge in self.faces[face].coedges
            for vertex in (self.edges[coedge.edge].start, self.edges[coedge.edge].end)
        }
        return float(np.linalg.norm(np.ptp([self.vertices[n].point for n in numbers], axis=0)))

    def shell(self, shape: TopoDS_Shape, colour: Colour | None) -> Shell:
        """Faces of a shell; those that lie within a solid on both sides are taken apart."""
        found = []
        for face in each(shape, TopAbs_FACE):
            number = self.face(face, colour)
            if number is None:
                continue
            if face.Orientation() in (TopAbs_FORWARD, TopAbs_REVERSED):
                turned = face.Orientation() == TopAbs_REVERSED
                found.append((number, turned != self.faces[number].reversed))
            elif number not in self.free_faces:
                self._remarks["a face inside a solid is listed as free"] += 1
                self.free_faces.append(number)
        return tuple(found)

    def face(self, shape: TopoDS_Shape, colour: Colour | None) -> int | None:
        """Number of a face, taken in when it is met first; None for one without area, or one
        that cannot be used."""
        known = self._face_numbers.find(shape)
        if known is not None:
            return known
        if self._unusable.find(shape) is not None:
            return None
        before = self._counts()
        try:
            return self._new_face(shape, colour)
        except Exception as error:
            if not isinstance(error, SurfmeshError) and not _is_of_ocp(error):
                raise
            self._go_back(*before)
            self._unusable.add(shape)
            self.left_out.append(f"{face_in_words(shape, self._part)}: {_in_one_line(error)}")
            return None

    def _counts(self) -> tuple[int, ...]:
        return tuple(
            len(met) for met in (
                self.vertices, self.edges, self.faces, self._vertices_met,
                self._vertex_numbers, self._edge_numbers, self._face_numbers,
            )
        )  # fmt: skip

    def _go_back(self, *counts: int) -> None:
        """As if nothing had been met since ``_counts`` said so."""
        lists = self.vertices, self.edges, self.faces, self._vertices_met
        for items, count in zip(lists, counts):
            del items[count:]
        numberings = self._vertex_numbers, self._edge_numbers, self._face_numbers
        for numbering, count in zip(numberings, counts[len(lists) :]):
            numbering.forget_after(count)

    def _new_face(self, shape: TopoDS_Shape, colour: Colour | None) -> int | None:
        if TopExp_Explorer(shape, TopAbs_EDGE).More() and _is_flat(TopoDS.Face_s(shape)):
            self._remarks["a face without area is left out"] += 1
            return None
        number = self._face_numbers.add(shape)
        name, own = self.detail(shape)
        called = f"face {number}" + (f" ({name})" if name else "")
        face = TopoDS.Face_s(shape.Oriented(TopAbs_FORWARD))
        loops = self._loops(face, called)
        if not loops:
            raise CadError("it has no edges; give the face its boundary in the CAD system")
        surface = surface_of(BRep_Tool.Surface_s(face), _box(face, loops, called), called)
        area = _area(face, surface.kind)
        closed = None not in surface.periods or surface.kind == "sphere"
        wrong = misdirected(loops, closed) if self.heal else []
        for place in wrong:
            loops[place] = turned(loops[place])
            self._remarks[f"{called}: a loop turned, loops are oriented by nesting"] += 1
        if wrong:
            ways = [1.0 if signed_area(loop) > 0.0 else -1.0 for loop in loops]
            parts = [self._area_within(face, loop, surface.kind) for loop in loops]
            area = sum(way * part for way, part in zip(ways, parts))
        loops += self._points_inside(face, surface, loops, called)
        self.faces.append(
            CadFace(
                surface=surface,
                loops=outer_first(loops),
                reversed=shape.Orientation() == TopAbs_REVERSED,
                tolerance=BRep_Tool.Tolerance_s(face),
                name=name,
                colour=own or colour,
                area=area,
                kind=surface.kind,
                names=self.names(shape),
            )
        )
        return number

    def _area_within(self, face: TopoDS_Face, loop: tuple[CadCoedge, ...], kind: str) -> float:
        """What a loop of a face encloses."""
        edges = {coedge.edge for coedge in loop}
        alone = face.EmptyCopied()
        for wire in _below(face):
            if edges & {self._edge_numbers.find(edge) for edge in each(wire, TopAbs_EDGE)}:
                BRep_Builder().Add(alone, wire)
        return _area(TopoDS.Face_s(alone), kind)

    def face_number(self, shape: TopoDS_Shape) -> int | None:
        """Number of a face that has been taken in."""
        return self._face_numbers.find(shape)

    def _points_inside(
        self, face: TopoDS_Face, surface: FaceSurface, loops: list, called: str
    ) -> list[tuple[CadCoedge, ...]]:
        """Loops of short edges, there and back, from vertices inside the face."""
        vertices = vertices_inside(face)
        found = []
        edges = short_edges(face, surface, loops, vertices) if vertices else []
        for vertex, short in zip(vertices, edges):
            if short is None:
                continue
            named = TopoDS_Edge()
            BRep_Builder().MakeEdge(named)
            number = self._edge_numbers.add(named)
            start, tolerance = self._vertex(vertex), BRep_Tool.Tolerance_s(vertex)
            (_, far) = short.curve.evaluate(np.array([0.0, short.end]), 0)[0]
            self.vertices.append(CadVertex(far, tolerance))
            self.edges.append(
                CadEdge(
                    curve=short.curve,
                    t0=0.0,
                    t1=short.end,
                    start=start,
                    end=len(self.vertices) - 1,
                    tolerance=tolerance,
                    degenerate=False,
                    name="",
                    length=short.length,
                )
            )
            there = CadCoedge(number, False, short.pcurve, 0.0, short.end, True)
            found.append((there, replace(there, reversed=True)))
            self._remarks[f"{called} is touched in a point: a short edge makes a node of it"] += 1
        return found

    def _loops(self, face: TopoDS_Face, called: str) -> list[tuple[CadCoedge, ...]]:
        wires = [list(_below(wire)) for wire in _below(face) if wire.ShapeType() == TopAbs_WIRE]
        uses: Counter[int] = Counter()
        for edge in (edge for wire in wires for edge in wire):
            number = self.edge(TopoDS.Edge_s(edge), face)
            uses[number] += 2 if edge.Orientation() == TopAbs_INTERNAL else 1
        loops, inside = [], []
        for wire in wires:
            around = []
            for shape in wire:
                edge = TopoDS.Edge_s(shape)
                number = self.edge(edge, face)
                if edge.Orientation() == TopAbs_EXTERNAL:
                    self._remarks[f"{called}: an edge outside the face is left out"] += 1
                    continue
                seam = uses[number] > 1
                if edge.Orientation() == TopAbs_INTERNAL:
                    edge = TopoDS.Edge_s(edge.Oriented(TopAbs_FORWARD))
                    forward = self._coedge(edge, face, number, seam, called)
                    inside.append((forward, replace(forward, reversed=True)))
                else:
                    around.append(self._coedge(edge, face, number, seam, called))
            if around:
                loops += chained(around, self.edges)
        return loops + there_and_back(inside, self.edges)

    def _coedge(
        self, edge: TopoDS_Edge, face: TopoDS_Face, number: int, seam: bool, called: str
    ) -> CadCoedge:
        pcurve = BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0)
        if pcurve is None:
            ShapeFix_Edge().FixAddPCurve(edge, face, False, Precision.Confusion_s())
            pcurve = BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0)
        if pcurve is None:
            raise CadError(f"{called}: edge {number} cannot be projected onto it")
        p0, p1 = BRep_Tool.Range_s(edge, face)
        try:
            curve = curve2d_of(pcurve).with_limits(p0, p1)
        except CadError as error:
            raise CadError(f"{called}, edge {number}: {error}") from None
        return CadCoedge(number, edge.Orientation() == TopAbs_REVERSED, curve, p0, p1, seam)

    def edge(self, shape: TopoDS_Edge, face: TopoDS_Face) -> int:
        """Number of an edge, taken in when it is met first; face: one that uses it."""
        known = self._edge_numbers.find(shape)
        if known is not None:
            return known
        number = self._edge_numbers.add(shape)
        edge = TopoDS.Edge_s(shape.Oriented(TopAbs_FORWARD))
        # Degenerated_s also holds for an edge whose curve has merely been forgotten
        geometry = BRep_Tool.Curve_s(edge, 0.0, 0.0)
        degenerate = BRep_Tool.Degenerated_s(edge) or geometry is None
        t0, t1 = BRep_Tool.Range_s(edge, face) if degenerate else BRep_Tool.Range_s(edge)
        if not (abs(t0) < Precision.Infinite_s() and abs(t1) < Precision.Infinite_s()):
            raise CadError(f"edge {number} goes on to infinity; trim it in the CAD system")
        try:
            curve = None if degenerate else curve_of(geometry).with_limits(t0, t1)
        except CadError as error:
            raise CadError(f"edge {number}: {error}") from None
        start, end = self._ends(edge, curve, t0, t1)
        length = 0.0
        if not degenerate:
            length = GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge), t0, t1, 1e-9)
        self.edges.append(
            CadEdge(
                curve=curve,
                t0=t0,
                t1=t1,
                start=start,
                end=end,
                tolerance=BRep_Tool.Tolerance_s(edge),
                degenerate=degenerate,
                name=self.detail(shape)[0],
                length=length,
                names=self.names(shape),
            )
        )
        return number

    def _ends(self, edge: TopoDS_Edge, curve, t0: float, t1: float) -> tuple[int, int]:
        """Vertices at the ends; an edge that is closed without a vertex gets one."""
        first, last = TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)
        numbers = [None if v.IsNull() else self._vertex(v) for v in (first, last)]
        if None not in numbers:
            return numbers[0], numbers[1]
        if curve is None:
            raise CadError("a degenerate edge has no vertex; let the CAD system repair the model")
        tolerance = BRep_Tool.Tolerance_s(edge)
        points = curve.evaluate(np.array([t0, t1]), 0)[0]
        if numbers == [None, None] and np.linalg.norm(points[1] - points[0]) <= 2.0 * tolerance:
            self.vertices.append(CadVertex(points[0], tolerance))
            return len(self.vertices) - 1, len(self.vertices) - 1
        for place in range(2):
            if numbers[place] is None:
                numbers[place] = len(self.vertices)
                self.vertices.append(CadVertex(points[place], tolerance))
        return numbers[0], numbers[1]

    def _vertex(self, shape: TopoDS_Shape) -> int:
        known = self._vertex_numbers.find(shape)
        if known is not None:
            return self._vertices_met[known]
        self._vertex_numbers.add(shape)
        self._vertices_met.append(len(self.vertices))
        vertex = TopoDS.Vertex_s(shape)
        point = BRep_Tool.Pnt_s(vertex)
        where = np.array([point.X(), point.Y(), point.Z()])
        self.vertices.append(CadVertex(where, BRep_Tool.Tolerance_s(vertex)))
        return self._vertices_met[-1]

    def number_of(self, shape: TopoDS_Shape) -> str:
        """ "face 3", "edge 12", "solid 1"; nothing for what is not in the model."""
        for kind, numbers in (
            ("face", self._face_numbers), ("edge", self._edge_numbers),
            ("solid", self._solid_numbers),
        ):  # fmt: skip
            number = numbers.find(shape)
            if number is not None:
                return f"{kind} {number}"
        return ""

    def tags(self, root: Part) -> tuple[CadTag, ...]:
        """Of all parts by the numbers of what they stand for; one name is one tag."""
        found: dict[str, list[CadTag]] = {}
        for tag in (tag for part in root for tag in part.tags):
            numbers: dict[str, set[int]] = {"faces": set(), "edges": set(), "vertices": set()}
            numbers["solids"] = set()
            for shape in (shape for shape in tag.shapes if not shape.IsNull()):
                many, kind = _TAGGED.get(shape.ShapeType(), ("faces", TopAbs_FACE))
                # healing may have split a face or an edge
                known = [self._number(many, one) for one in each(shape, kind)]
                numbers[many].update(number for number in known if number is not None)
            sorts = {many: tuple(sorted(some)) for many, some in numbers.items()}
            found.setdefault(tag.name, []).append(CadTag(tag.name, tag.held, **sorts))
        return tuple(parts[0] if len(parts) == 1 else _one_tag(parts) for parts in found.values())

    def _number(self, many: str, shape: TopoDS_Shape) -> int | None:
        if many == "vertices":
            known = self._vertex_numbers.find(shape)
            return None if known is None else self._vertices_met[known]
        numbers = {"faces": self._face_numbers, "edges": self._edge_numbers}
        return numbers.get(many, self._solid_numbers).find(shape)

    def remarks(self) -> list[str]:
        """What was found on the way, with how often."""
        return [text + (f" ({n} times)" if n > 1 else "") for text, n in self._remarks.items()]


def _one_tag(parts: list[CadTag]) -> CadTag:
    """The tags of one name in several parts."""
    every = {
        many: tuple(sorted({number for part in parts for number in getattr(part, many)}))
        for many in ("faces", "edges", "vertices", "solids")
    }
    return CadTag(parts[0].name, ", ".join(dict.fromkeys(p.held for p in parts)), **every)


def _touching(faces: list[CadFace], solids: list[CadSolid]) -> list[str]:
    """Edges along which a solid touches itself: no mesh of it is a manifold there."""
    sentences = []
    for number, solid in enumerate(solids):
        uses: Counter[int] = Counter()
        for face, _ in (use for shell in solid.shells for use in shell):
            uses.update(coedge.edge for coedge in faces[face].coedges)
        many = [str(edge) for edge, count in sorted(uses.items()) if count > 2]
        if many:
            sentences.append(
                f"solid {number} touches itself along edge{'s' if len(many) > 1 else ''} "
                f"{listed(many)}: more than two of its faces meet there, and so do triangles"
            )
    return sentences


def _fault_split_faces(walk: _Walk, root: Part) -> None:
    """Pieces that healing has made of one face, and that cross each other, are no faces."""
    for part in root:
        for shape, _ in part.remarks:
            if shape is None or shape.IsNull():
                continue
            numbers = [walk.face_number(face) for face in each(shape, TopAbs_FACE)]
            numbers = sorted({number for number in numbers if number is not None})
            pieces = [walk.faces[number] for number in numbers]
            if len(pieces) < 2:
                continue
            fault = fault_of_pieces(pieces, walk.edges, len(walk.vertices))
            for number in numbers if fault else ():
                said = f"{fault}, before it was split by healing"
                walk.faces[number] = replace(walk.faces[number], fault=said)


def _in_words(walk: _Walk, root: Part) -> list[str]:
    """What healing did, by face or edge; what was done to many of them in one sentence."""
    places: dict[tuple[str, str], list[str]] = {}
    for part in root:
        for shape, text in part.remarks:
            found = [] if shape is None or shape.IsNull() else [shape]
            if found and shape.ShapeType() not in (TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE):
                found = list(each(shape, TopAbs_FACE))  # a face that was split
            names = [name for name in map(walk.number_of, found) if name]
            kind = names[0].split()[0] if names else ""
            numbers = places.setdefault((kind, text), [])
            numbers += [name.split()[1] for name in names] or [part.name]
    sentences = []
    for (kind, text), numbers in places.items():
        numbers = list(dict.fromkeys(numbers))
        label = f"{kind}{'s' * (len(numbers) > 1)} " if kind else "part "
        sentences.append(f"{label}{listed(numbers)}: {text}")
    notes = [note for part in root for note in part.notes]
    places = [("" if shape is None else walk.number_of(shape)) for shape, _ in notes]
    said = [f"{place}: {text}" if place else text for place, (_, text) in zip(places, notes)]
    return sentences + said


def _below(shape: TopoDS_Shape) -> Iterator[TopoDS_Shape]:
    """Direct sub-shapes, located and oriented as they are used."""
    iterator = TopoDS_Iterator(shape)
    while iterator.More():
        yield iterator.Value()
        iterator.Next()


def _accuracy(kinds: list[str]) -> float:
    return EXACT if ELEMENTARY.issuperset(kinds) else EXACT_FREE_FORM


def _volume(shape: TopoDS_Shape, kinds: list[str]) -> float:
    """Signed: negative where the faces of a solid are turned inside out."""
    properties = GProp_GProps()
    if "extrusion" in kinds:  # as for areas: adaptive integration is up to 3 % off
        BRepGProp.VolumeProperties_s(shape, properties)
    else:
        BRepGProp.VolumeProperties_s(shape, properties, _accuracy(kinds))
    return properties.Mass()


def _area(face: TopoDS_Face, kind: str) -> float:
    properties = GProp_GProps()
    if kind == "extrusion":  # there adaptive integration misses more than it says, up to 2 %
        BRepGProp.SurfaceProperties_s(face, properties)
    else:
        BRepGProp.SurfaceProperties_s(face, properties, _accuracy([kind]))
    return abs(properties.Mass())


def _is_flat(face: TopoDS_Face) -> bool:
    """Whether its edges enclose nothing: their (u, v) box is a line or a point."""
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    return not (u1 - u0 > TINY * max(abs(u0), abs(u1)) and v1 - v0 > TINY * max(abs(v0), abs(v1)))


def _box(face: TopoDS_Face, loops: list, called: str) -> Domain:
    """The (u, v) box of the loops, widened to where their samples go."""
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    lo, hi = joined(((u0, u1), (v0, v1)), loops)
    if not np.abs([lo, hi]).max() < Precision.Infinite_s():
        raise CadError(f"{called} goes on to infinity; trim it in the CAD system")
    return ((float(lo[0]), float(hi[0])), (float(lo[1]), float(hi[1])))
