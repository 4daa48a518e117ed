"""Loose faces are joined along edges that lie within a tolerance; closed shells become solids.

     ______   ______             ______ ______
    |      | |      |           |      |      |    Two edges in the same place become one, which
    |      | |      |    ->     |      |      |    both faces use. Where several edges lie along
    |      | |______|           |      o______|    one, that is cut.
    |______|                    |______|

Faces of closed solids are left alone. A solid whose shell is open is taken apart and sewn anew.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from OCP.BOPAlgo import BOPAlgo_Builder, BOPAlgo_MakerVolume
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy, BRepBuilderAPI_Sewing
from OCP.BRepTools import BRepTools_Quilt
from OCP.TopAbs import (
    TopAbs_COMPOUND,
    TopAbs_COMPSOLID,
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_FORWARD,
    TopAbs_REVERSED,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_WIRE,
)
from OCP.TopoDS import TopoDS, TopoDS_Shape

from surfmesh.cad.healing.origins import Origins, remarks_again, tags_again
from surfmesh.cad.healing.shell_bodies import Body, PartPath, SewnShell, bodies_of
from surfmesh.cad.model.cad_model import Colour
from surfmesh.cad.parts import Detail, Part
from surfmesh.cad.sub_shapes import (
    ByShape,
    Numbering,
    compound_of,
    content,
    counted,
    each,
    said_by,
    unique,
)
from surfmesh.errors import CadError

_MADE_OF = {
    TopAbs_COMPOUND: TopAbs_FACE, TopAbs_COMPSOLID: TopAbs_FACE, TopAbs_SOLID: TopAbs_FACE,
    TopAbs_SHELL: TopAbs_FACE, TopAbs_WIRE: TopAbs_EDGE,
}  # fmt: skip


def sewn(root: Part, tolerance: float) -> Part:
    """The same tree with its loose faces joined.

    root: healed and in place, in millimetres, as the tolerance. A shell of faces of several parts
    belongs to the part that holds these. Raises CadError when OCP gives up.
    """
    paths = list(_with_paths(root))
    loose = [_Loose(face, path) for path, part in paths for face in _loose_faces(part)]
    if not loose:
        return root.noted([(None, "sewn: there are no loose faces")])
    history = _Sewn([entry.face for entry in loose], tolerance)
    shells = _shells(history, loose, dict(paths))
    bodies = bodies_of(shells)
    origins = Origins(root, history)
    for shell in shells:
        for face, colour in shell.inherited:
            origins.add(face, Detail(face, "", colour))
    done = _rebuilt(root, (), history, bodies, origins)
    return done.noted((None, note) for note in _notes(loose, history, bodies))


@dataclass(frozen=True)
class _Loose:
    face: TopoDS_Shape
    path: PartPath


def _with_paths(part: Part, path: PartPath = ()) -> Iterable[tuple[PartPath, Part]]:
    yield path, part
    for number, child in enumerate(part.children):
        yield from _with_paths(child, (*path, number))


def _loose_faces(part: Part) -> list[TopoDS_Shape]:
    """Faces of no solid, and those of solids that are open."""
    if part.shape is None:
        return []
    found = list(each(part.shape, TopAbs_FACE, TopAbs_SOLID))
    for solid in each(part.shape, TopAbs_SOLID):
        if _is_open(solid):
            found += each(solid, TopAbs_FACE)
    return found


def _is_open(solid: TopoDS_Shape) -> bool:
    return not all(BRep_Tool.IsClosed_s(shell) for shell in each(solid, TopAbs_SHELL))


class _Sewn:
    """What was sewn, and what became of each shape. pieces: shells, faces and solids."""

    def __init__(self, faces: list[TopoDS_Shape], tolerance: float) -> None:
        self._copy = BRepBuilderAPI_Copy(compound_of(faces))  # the shapes are the caller's
        self._loose = Numbering(faces)
        self._sewing = BRepBuilderAPI_Sewing(tolerance)
        self._sewing.SetNonManifoldMode(True)  # else two of many edges are joined, whichever
        for face in faces:
            self._sewing.Add(self._copied(face))
        try:
            self._sewing.Perform()
            self._fuses: list[BOPAlgo_Builder] = []
            self.pieces = self._pieces(tolerance)
        except Exception as error:  # OCP's own exceptions have no common parent in Python
            reason = said_by(error)
            raise CadError(
                f"the faces cannot be sewn: OCP gave up, {reason}; try a smaller sew=TOLERANCE"
            ) from None
        self._held = Numbering(self.pieces)

    def _copied(self, shape: TopoDS_Shape) -> TopoDS_Shape:
        return self._copy.ModifiedShape(shape).Oriented(shape.Orientation())

    def _pieces(self, tolerance: float) -> list[TopoDS_Shape]:
        shape, found = self._sewing.SewedShape(), []
        for faces in _connected([] if shape.IsNull() else unique(shape, TopAbs_FACE)):
            if not any(count > 2 for count in _uses(faces)):
                found += _quilted(faces)
                continue
            fuse = BOPAlgo_Builder()  # whatever bodies these faces bound, touching ones
            for face in faces:
                fuse.AddArgument(face)
            fuse.SetFuzzyValue(tolerance)
            fuse.Perform()
            self._fuses.append(fuse)
            found += _regions(unique(fuse.Shape(), TopAbs_FACE))
        return found

    def images(self, shape: TopoDS_Shape) -> list[TopoDS_Shape]:
        """What a shape has become; itself where it was not loose."""
        if shape.IsNull():
            return []
        kind = shape.ShapeType()
        if kind == TopAbs_SOLID and not _is_open(shape):
            return [shape]
        part = _MADE_OF.get(kind)
        if part is not None:
            return [image for below in each(shape, part) for image in self.images(below)]
        if shape not in self._loose:
            return [shape]
        copy = self._copied(shape)
        if kind == TopAbs_FACE:
            sewn = self._sewing.Modified(copy) if self._sewing.IsModified(copy) else copy
        else:
            sewn = self._sewing.ModifiedSubShape(copy)
        found = [] if sewn.IsNull() else [
            last for first in each(sewn, kind) for last in self._fused(first)
        ]  # fmt: skip
        return [image for image in found if image in self._held]

    def _fused(self, shape: TopoDS_Shape) -> list[TopoDS_Shape]:
        """What became of a sewn shape where more than two faces met."""
        for fuse in self._fuses:
            found = list(fuse.Modified(shape))
            if found:
                return found
        return [shape]


def _own_edges(face: TopoDS_Shape) -> list[TopoDS_Shape]:
    """The edges of a face that bound it, seams twice."""
    edges = each(face.Oriented(TopAbs_FORWARD), TopAbs_EDGE)
    ways = (TopAbs_FORWARD, TopAbs_REVERSED)
    return [
        edge for edge in edges
        if edge.Orientation() in ways and not BRep_Tool.Degenerated_s(TopoDS.Edge_s(edge))
    ]  # fmt: skip


def _uses(faces: list[TopoDS_Shape]) -> list[int]:
    """How often each edge of faces bounds one of them."""
    uses: ByShape[list[TopoDS_Shape]] = ByShape()
    for face in faces:
        for edge in _own_edges(face):
            uses.setdefault(edge, []).append(face)
    return [len(users) for _, users in uses.items()]


def _connected(faces: list[TopoDS_Shape]) -> list[list[TopoDS_Shape]]:
    """Faces in groups that hang together by edges."""
    users: ByShape[list[int]] = ByShape()
    edges = [_own_edges(face) for face in faces]
    for number, own in enumerate(edges):
        for edge in own:
            users.setdefault(edge, []).append(number)
    group = [-1] * len(faces)
    found: list[list[TopoDS_Shape]] = []
    for first in range(len(faces)):
        if group[first] >= 0:
            continue
        waiting, group[first] = [first], len(found)
        members = []
        while waiting:
            number = waiting.pop()
            members.append(number)
            for edge in edges[number]:
                for other in users.get(edge) or ():
                    if group[other] < 0:
                        group[other] = group[first]
                        waiting.append(other)
        found.append([faces[number] for number in sorted(members)])
    return found


def _quilted(faces: list[TopoDS_Shape]) -> list[TopoDS_Shape]:
    """Shells of faces that look the same way."""
    quilt = BRepTools_Quilt()
    for face in faces:
        quilt.Add(face)
    return list(each(quilt.Shells(), TopAbs_SHELL))


def _regions(faces: list[TopoDS_Shape]) -> list[TopoDS_Shape]:
    """The solids that faces bound, which share what is between them, and the faces left over."""
    maker = BOPAlgo_MakerVolume()
    for face in faces:
        maker.AddArgument(face)
    maker.SetIntersect(False)
    maker.Perform()
    solids = [] if maker.HasErrors() else list(each(maker.Shape(), TopAbs_SOLID))
    taken = Numbering(solids, TopAbs_FACE)
    left = [face for face in faces if face not in taken]
    found = list(solids)
    for group in _connected(left):
        branching = any(count > 2 for count in _uses(group))
        found += group if branching else _quilted(group)
    return found


def _shells(history: _Sewn, loose: list[_Loose], parts: dict[PartPath, Part]) -> list[SewnShell]:
    """What hangs together, with the part it belongs to."""
    of: ByShape[list[tuple[_Loose, TopoDS_Shape]]] = ByShape()  # new face -> old ones
    for entry in loose:
        for image in history.images(entry.face):
            of.setdefault(image, []).append((entry, image))
    found = []
    for piece in history.pieces:
        origins, turned = [], 0
        for face in each(piece, TopAbs_FACE):
            for entry, image in of.get(face) or []:
                origins.append((face, entry.path))
                turned += 1 if image.Orientation() != face.Orientation() else -1
        path = _common([below for _, below in origins])
        colours = [(face, _colour(parts, path, below)) for face, below in origins]
        is_inward = (content(piece, 3) < 0.0) != (turned > 0)
        found.append(SewnShell(piece, path, [(f, c) for f, c in colours if c], is_inward))
    return found


def _common(paths: list[PartPath]) -> PartPath:
    """The longest beginning that all have."""
    if not paths:
        return ()
    first, last = min(paths), max(paths)
    same = next((k for k, (a, b) in enumerate(zip(first, last)) if a != b), None)
    return first[: min(len(first), len(last)) if same is None else same]


def _colour(parts: dict[PartPath, Part], path: PartPath, below: PartPath) -> Colour | None:
    """What a part below another gives its faces and the other does not."""
    for end in range(len(below), len(path), -1):
        if parts[below[:end]].colour:
            return parts[below[:end]].colour
    return None


def _rebuilt(
    part: Part, path: PartPath, history: _Sewn, bodies: list[Body], origins: Origins
) -> Part:
    """The part with all below it, made of what was sewn."""
    own = [body.shape for body in bodies if body.path == path]
    shapes = own
    if part.shape is not None:
        shapes = [s for s in each(part.shape, TopAbs_SOLID) if not _is_open(s)] + own
        there = Numbering(shapes, TopAbs_FACE)
        beside = [image for face in _loose_faces(part) for image in history.images(face)]
        shapes += [face for face in beside if face not in there]  # of a part above
    children = [
        _rebuilt(child, (*path, number), history, bodies, origins)
        for number, child in enumerate(part.children)
    ]
    return replace(
        part,
        shape=compound_of(shapes) if shapes or part.shape is not None else None,
        details=origins.details(shapes),
        remarks=remarks_again(part, history),
        tags=tags_again(part, history),
        children=children,
    )


def _notes(loose: list[_Loose], history: _Sewn, bodies: list[Body]) -> list[str]:
    """How many edges were joined, how many are left free, what became of it all."""
    before: ByShape[list[TopoDS_Shape]] = ByShape()
    for entry in loose:
        for edge in unique(entry.face, TopAbs_EDGE):
            for image in history.images(edge):
                before.setdefault(image, []).append(edge)
    joined = sum(len(Numbering(edges, TopAbs_EDGE)) > 1 for _, edges in before.items())
    free, branching = _free_edges(bodies)
    words = [f"{counted(joined, 'edge')} joined", f"{free:,} {'is' if free == 1 else 'are'} free"]
    solids = sum(body.shape.ShapeType() == TopAbs_SOLID for body in bodies)
    if solids:
        words.append(f"{counted(solids, 'solid')} made")
    if branching:
        words.append(f"{counted(branching, 'edge')} of more than two faces")
    notes = [f"sewn: of {counted(len(loose), 'loose face')} {', '.join(words)}"]
    lost = sum(not history.images(entry.face) for entry in loose)
    if lost:
        notes.append(f"{counted(lost, 'face')} narrower than the tolerance vanished")
    return notes


def _free_edges(bodies: list[Body]) -> tuple[int, int]:
    """Edges that are the border of one face; those where more than two meet."""
    counts = _uses(list(Numbering((body.shape for body in bodies), TopAbs_FACE)))
    return sum(c == 1 for c in counts), sum(c > 2 for c in counts)
