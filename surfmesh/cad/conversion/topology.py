"""From OCP's shapes to a `CadModel`: every vertex, edge and face once, by number.

Shapes are the same when TShape and location are (``IsSame``); orientation is kept where a shape
is used: in the coedges of a face and in the shells of a solid.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepTools import BRepTools
from OCP.Precision import Precision
from OCP.TopAbs import (
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_FORWARD,
    TopAbs_REVERSED,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_VERTEX,
    TopAbs_WIRE,
)
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape

from surfmesh.cad.conversion.convert import surface_of
from surfmesh.cad.conversion.edges_met import EdgesMet
from surfmesh.cad.model.cad_model import (
    CadEdge,
    CadFace,
    CadNode,
    CadSolid,
    CadTag,
    CadVertex,
    Colour,
    Shell,
)
from surfmesh.cad.model.invariants import is_closed, signed_area
from surfmesh.cad.model.loops import Loop, misdirected, outer_first, turned
from surfmesh.cad.model.tolerances import joined
from surfmesh.cad.parts import Details, Part, face_in_words
from surfmesh.cad.sub_shapes import Numbering, below, content, each, volume_within
from surfmesh.errors import CadError, SurfmeshError
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.number_range import RANGE
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.surface import Domain

# relative error of areas and volumes of faces by adaptive integration, which is slow on splines
EXACT = 1e-8
EXACT_FREE_FORM = 1e-6
ELEMENTARY = {"plane", "cylinder", "cone", "sphere", "torus"}
# on these, within such p-curves, fixed Gauss points do: what is integrated are polynomials and
# sines of low degree (over 3,400 faces of files and parts they err by 6e-12 at most)
SMOOTH = {"line", "circle", "ellipse"}
TINY = 1e-14  # of its distance from the origin: a (u, v) box so narrow is a line


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


class Walk:
    """What has been met so far on the way through the parts."""

    def __init__(self, heal: bool) -> None:
        self.heal = heal
        self.faces: list[CadFace] = []
        self.solids: list[CadSolid] = []
        self.free_shells: list[Shell] = []
        self.free_faces: list[int] = []
        self._face_numbers = Numbering()
        self._solid_numbers = Numbering()
        self._details = Details()
        self._remarks: Counter[str] = Counter()
        self._met = EdgesMet(self._details, self._remarks)
        self.left_out: list[str] = []
        self._unusable = Numbering()
        self._part = Part("")  # that is walked through

    @property
    def vertices(self) -> list[CadVertex]:
        return self._met.vertices

    @property
    def edges(self) -> list[CadEdge]:
        return self._met.edges

    def part(self, part: Part, colour: Colour | None) -> CadNode:
        """Take in a part and all below it; colour: what it inherits."""
        colour = part.colour or colour
        solids: list[int] = []
        faces: list[int] = []
        self.left_out += part.left_out
        if part.shape is not None:
            self._part = part
            self._details.add(part.details)
            found = [self.solid(s, part, colour) for s in each(part.shape, TopAbs_SOLID)]
            solids = [number for number in found if number is not None]
            for shape in each(part.shape, TopAbs_SHELL, TopAbs_SOLID):
                shell = self.shell(shape, self._details.of(shape).colour or colour)
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

    def solid(self, shape: TopoDS_Shape, part: Part, colour: Colour | None) -> int | None:
        """Number of a solid, taken in when it is met first; None for one without faces."""
        number = self._solid_numbers.find(shape)
        if number is not None:
            return number
        known = self._details.of(shape)
        colour = known.colour or colour
        every = (
            self.shell(shell, self._details.of(shell).colour or colour)
            for shell in each(shape, TopAbs_SHELL)
        )
        shells = [shell for shell in every if shell]
        if not shells:
            self._remarks["a solid without faces is left out"] += 1
            return None
        volume = self._volume(shape, shells)
        if volume < 0.0:
            self._remarks[f"solid {len(self.solids)} was inside out: its faces are turned"] += 1
            shells = [tuple((face, not against) for face, against in shell) for shell in shells]
        self._solid_numbers.add(shape)
        shells.sort(key=self._extent, reverse=True)
        self.solids.append(
            CadSolid(
                shells=tuple(shells),
                name=known.name or part.name,
                colour=colour,
                volume=abs(volume),
                closed=is_closed(self.faces, shells, self.edges),
                names=known.names,
            )
        )
        return len(self.solids) - 1

    def _volume(self, shape: TopoDS_Shape, shells: list[Shell]) -> float:
        """Of a solid, negative inside out: each face integrated as it asks for."""
        numbers = {face for shell in shells for face, _ in shell}
        errors = {n: _error(self.faces[n].kind, self.faces[n].loops) for n in numbers}
        extruded = any(self.faces[number].kind == "extrusion" for number in numbers)
        if extruded or all(error is None for error in errors.values()):
            return content(shape, 3)
        faces = list(each(shape, TopAbs_FACE))
        found = map(self._face_numbers.find, faces)
        asked = [EXACT if number is None else errors.get(number, EXACT) for number in found]
        return volume_within(faces, asked, self._points(shells).mean(axis=0))

    def _extent(self, shell: Shell) -> float:
        """Diagonal of the box of a shell's vertices: the outer shell has the largest."""
        return diagonal(self._points([shell]))

    def _points(self, shells: list[Shell]) -> np.ndarray:
        """(n, 3) The vertices of shells, as often as coedges of faces start or end there."""
        coedges = (c for shell in shells for n, _ in shell for c in self.faces[n].coedges)
        edges = (self.edges[coedge.edge] for coedge in coedges)
        ends = (vertex for edge in edges for vertex in (edge.start, edge.end))
        return np.array([self.vertices[vertex].point for vertex in ends])

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
        before, faces = self._met.counts(), len(self._face_numbers)
        try:
            return self._new_face(shape, colour)
        except Exception as error:
            if not isinstance(error, SurfmeshError) and not _is_of_ocp(error):
                raise
            self._met.go_back(before)
            self._face_numbers.forget_after(faces)
            del self.faces[faces:]
            self._unusable.add(shape)
            which = face_in_words(shape, self._part, Numbering([self._part.shape], TopAbs_FACE))
            self.left_out.append(f"{which}: {_in_one_line(error)}")
            return None

    def _new_face(self, shape: TopoDS_Shape, colour: Colour | None) -> int | None:
        if any(True for _ in each(shape, TopAbs_EDGE)) and _is_flat(TopoDS.Face_s(shape)):
            self._remarks["a face without area is left out"] += 1
            return None
        number = self._face_numbers.add(shape)
        known = self._details.of(shape)
        called = f"face {number}" + (f" ({known.name})" if known.name else "")
        face = TopoDS.Face_s(shape.Oriented(TopAbs_FORWARD))
        loops = self._met.loops(face, called)
        if not loops:
            raise CadError("it has no edges; give the face its boundary in the CAD system")
        surface = surface_of(BRep_Tool.Surface_s(face), _box(face, loops, called), called)
        _require_numbers(surface)
        area = _area(face, surface.kind, loops)
        closed = None not in surface.periods or surface.kind == "sphere"
        wrong = misdirected(loops, closed) if self.heal else []
        for place in wrong:
            loops[place] = turned(loops[place])
            self._remarks[f"{called}: a loop turned, loops are oriented by nesting"] += 1
        if wrong:
            ways = [1.0 if signed_area(loop) > 0.0 else -1.0 for loop in loops]
            parts = [self._area_within(face, loop, surface.kind) for loop in loops]
            area = sum(way * part for way, part in zip(ways, parts))
        loops += self._met.points_inside(face, surface, loops, called)
        self.faces.append(
            CadFace(
                surface=surface,
                loops=outer_first(loops),
                reversed=shape.Orientation() == TopAbs_REVERSED,
                tolerance=BRep_Tool.Tolerance_s(face),
                name=known.name,
                colour=known.colour or colour,
                area=area,
                kind=surface.kind,
                names=known.names,
            )
        )
        return number

    def _area_within(self, face: TopoDS_Face, loop: Loop, kind: str) -> float:
        """What a loop of a face encloses."""
        edges = {coedge.edge for coedge in loop}
        alone = face.EmptyCopied()
        for wire in below(face):
            if edges & {self._met.numbers.find(edge) for edge in each(wire, TopAbs_EDGE)}:
                BRep_Builder().Add(alone, wire)
        return _area(alone, kind, [loop])

    def face_number(self, shape: TopoDS_Shape) -> int | None:
        """Number of a face that has been taken in."""
        return self._face_numbers.find(shape)

    def number_of(self, shape: TopoDS_Shape) -> str:
        """ "face 3", "edge 12", "solid 1"; nothing for what is not in the model."""
        for kind, numbers in (
            ("face", self._face_numbers), ("edge", self._met.numbers),
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
            return self._met.vertex_number(shape)
        numbers = {"faces": self._face_numbers, "edges": self._met.numbers}
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


def _require_numbers(surface: FaceSurface) -> None:
    """Raise CadError for a surface whose frame or radius is no number to compute with."""
    points = surface.evaluate(parameter_grid(surface.domain, 3))[0]
    if np.isnan(points).any(axis=1).all():  # at some an offset surface may have none
        raise CadError(f"its {surface.kind} is given by numbers that are not finite")
    if (np.abs(points) > RANGE.coordinate).any():
        raise CadError(f"its {surface.kind} has points too far away to compute with")


def _area(face: TopoDS_Face, kind: str, loops: Iterable[Loop]) -> float:
    """Of a face on a surface of this kind."""
    return abs(content(face, 2, _error(kind, loops)))


def _error(kind: str, loops: Iterable[Loop]) -> float | None:
    """Relative, of the integral over a face within these loops; None: fixed Gauss points do."""
    if kind == "extrusion":  # there adaptive integration misses more than it says, up to 3 %
        return None
    if kind not in ELEMENTARY:
        return EXACT_FREE_FORM
    smooth = all(coedge.pcurve.kind in SMOOTH for loop in loops for coedge in loop)
    return None if smooth else EXACT


def _is_flat(face: TopoDS_Face) -> bool:
    """Whether its edges enclose nothing: their (u, v) box is a line or a point."""
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    return not (u1 - u0 > TINY * max(abs(u0), abs(u1)) and v1 - v0 > TINY * max(abs(v0), abs(v1)))


def _box(face: TopoDS_Face, loops: list[Loop], called: str) -> Domain:
    """The (u, v) box of the loops, widened to where their samples go."""
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    lo, hi = joined(((u0, u1), (v0, v1)), loops)
    if not np.abs([lo, hi]).max() < Precision.Infinite_s():
        raise CadError(f"{called} goes on to infinity; trim it in the CAD system")
    return ((float(lo[0]), float(hi[0])), (float(lo[1]), float(hi[1])))
