"""Touching bodies share their faces: the general fuse of OCP, with all names carried along.

     ______ ______           ______ ______
    |      |      |         |      |      |      Where bodies touch, both their faces are cut
    |  a   |   b  |   ->    |  a   |   b  |      along what they have in common, and each common
    |      |______|         |      o______|      piece is one face, behind it a, before it b. Where
    |______|                |______|             they overlap, their common part is one body more.

What comes of a shape keeps its name and colour; what comes of several has the names of all, in
the order of the parts in the tree. A sheet that lies on a body is a face of that body.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from OCP.BOPAlgo import BOPAlgo_Builder
from OCP.BRep import BRep_Builder
from OCP.Message import Message_Gravity
from OCP.TopAbs import (
    TopAbs_COMPOUND,
    TopAbs_COMPSOLID,
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_ShapeEnum,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_VERTEX,
    TopAbs_WIRE,
)
from OCP.TopoDS import TopoDS_Shape, TopoDS_Shell

from surfmesh.cad.healing.origins import Origins, remarks_again, tags_again
from surfmesh.cad.parts import Part
from surfmesh.cad.sub_shapes import (
    ByShape,
    Numbering,
    box_diagonal,
    compound_of,
    content,
    counted,
    each,
    said_by,
    unique,
)
from surfmesh.errors import CadError

TOUCH = 1e-7
"""Of the diagonal: bodies that are as near touch where no tolerance is given. Coordinates in files
and motions of placed parts are rounded, and no feature is as small."""

LOST = 1e-5
"""Of its volume: so much the pieces of a solid may differ from it by integration alone; besides, by
a layer as thick as the tolerance."""

Owners = dict[TopAbs_ShapeEnum, ByShape[dict[int, None]]]
"""Of shapes of each kind: the numbers of the bodies that have them, in order."""

CURE = "repair the bodies, or try a larger imprint=TOLERANCE"

_MADE_OF = {
    TopAbs_COMPOUND: TopAbs_FACE, TopAbs_COMPSOLID: TopAbs_FACE, TopAbs_SHELL: TopAbs_FACE,
    TopAbs_WIRE: TopAbs_EDGE,
}  # fmt: skip
"""The fuse knows what became of vertices, edges, faces and solids; of others, of their parts."""


def imprinted(root: Part, tolerance: float | None = None) -> Part:
    """The same tree, in which faces, edges and vertices where bodies touch are there once.

    root: healed and in place, in millimetres. tolerance: what is as near touches, in millimetres;
    None for a fraction of the diagonal. Raises CadError when OCP gives up or loses part of a solid.
    """
    bodies = _bodies(root)
    if len(bodies) < 2:
        return root.noted([(None, "imprinted: there is one body alone")])
    if tolerance is None:
        tolerance = TOUCH * box_diagonal(body.shape for body in bodies)
    fused = _Fused(bodies, tolerance)
    for body in bodies:
        _require_whole(body, fused, tolerance)
    origins = Origins(root, fused)
    solids = (image for b in bodies if b.is_solid for image in fused.images(b.shape))
    in_solids = Numbering(solids, TopAbs_FACE)
    done = _rebuilt(root, fused, origins, in_solids, Numbering())
    return done.noted(_notes(bodies, fused, tolerance))


@dataclass(frozen=True)
class _Body:
    """A solid, or a face of none, and what it is called."""

    shape: TopoDS_Shape
    name: str

    @property
    def is_solid(self) -> bool:
        return self.shape.ShapeType() == TopAbs_SOLID


def _bodies(root: Part) -> list[_Body]:
    """All solids and loose faces in the order of the tree; what is there twice, once."""
    found, seen = [], Numbering()
    for part in root:
        if part.shape is None:
            continue
        names: ByShape[str] = ByShape()
        for detail in part.details:
            names.setdefault(detail.shape, detail.name)
        solids = each(part.shape, TopAbs_SOLID)
        for shape in (*solids, *each(part.shape, TopAbs_FACE, TopAbs_SOLID)):
            if shape not in seen:
                seen.add(shape)
                found.append(_Body(shape, names.get(shape) or part.name))
    return found


class _Fused:
    """The result of the general fuse, and what became of each shape."""

    def __init__(self, bodies: list[_Body], tolerance: float) -> None:
        self._fuse = BOPAlgo_Builder()
        for body in bodies:
            self._fuse.AddArgument(body.shape)
        self._fuse.SetNonDestructive(True)  # the shapes are the caller's
        self._fuse.SetUseOBB(True)
        self._fuse.SetFuzzyValue(tolerance)
        try:
            self._fuse.Perform()
        except Exception as error:  # OCP's own exceptions have no common parent in Python
            reason = said_by(error)
            raise CadError(f"the bodies cannot be imprinted: OCP gave up, {reason}") from None
        if self._fuse.HasErrors():
            raise CadError(f"the bodies cannot be imprinted: OCP gave up, {self._reason()}; {CURE}")
        self._held = Numbering([self._fuse.Shape()])

    def images(self, shape: TopoDS_Shape) -> list[TopoDS_Shape]:
        """What a shape of the arguments has become: several where it was cut, none where lost."""
        if shape.IsNull():
            return []
        kind = _MADE_OF.get(shape.ShapeType())
        if kind is not None:
            return [image for part in each(shape, kind) for image in self.images(part)]
        found = list(self._fuse.Modified(shape))
        if not found and not self._fuse.IsDeleted(shape):
            found = [shape]
        return [image for image in found if image in self._held]

    def _reason(self) -> str:
        alerts = self._fuse.GetReport().GetAlerts(Message_Gravity.Message_Fail)
        kinds = [alert.DynamicType().Name().removeprefix("BOPAlgo_Alert") for alert in alerts]
        return ", ".join(kinds) or "without a reason"


def _require_whole(body: _Body, fused: _Fused, tolerance: float) -> None:
    """Raises CadError when the pieces of a body are not all of it."""
    images = fused.images(body.shape)
    if len(images) == 1 and images[0].IsSame(body.shape):
        return
    what, unit = ("solid", "mm3") if body.is_solid else ("face", "mm2")
    dimension = 3 if body.is_solid else 2
    before, border = (abs(content(body.shape, d, 0.1 * LOST)) for d in (dimension, dimension - 1))
    after = sum(abs(content(image, dimension, 0.1 * LOST)) for image in images)
    if not abs(after - before) <= LOST * before + tolerance * border:
        raise CadError(
            f"the {what} of {body.name!r} cannot be imprinted: it has {before:.6g} {unit}, its "
            f"pieces {after:.6g}; {CURE}"
        )


def _rebuilt(
    part: Part, fused: _Fused, origins: Origins, in_solids: Numbering, taken: Numbering
) -> Part:
    """The part with all below it, made of what came out of the fuse.

    in_solids: faces of solids; taken: those that are in a free shell by now.
    """
    ready = part
    if part.shape is not None:
        solids = [s for old in each(part.shape, TopAbs_SOLID) for s in fused.images(old)]
        shapes = [*solids]
        for shell in each(part.shape, TopAbs_SHELL, TopAbs_SOLID):
            shapes += _shell_again(fused.images(shell), in_solids, taken)
        for face in each(part.shape, TopAbs_FACE, TopAbs_SHELL):
            shapes += fused.images(face)
        ready = replace(
            part,
            shape=compound_of(shapes),
            details=origins.details(shapes),
            remarks=remarks_again(part, fused),
            tags=tags_again(part, fused),
        )
    children = [_rebuilt(child, fused, origins, in_solids, taken) for child in part.children]
    return replace(ready, children=children)


def _shell_again(
    faces: list[TopoDS_Shape], in_solids: Numbering, taken: Numbering
) -> list[TopoDS_Shape]:
    """A free shell of these faces, and beside it those that are a solid's or another shell's."""
    shell, builder = TopoDS_Shell(), BRep_Builder()
    builder.MakeShell(shell)
    beside = []
    for face in faces:
        if face in in_solids or face in taken:
            beside.append(face)
        else:
            taken.add(face)
            builder.Add(shell, face)
    return [shell, *beside] if len(beside) < len(faces) else beside


def _notes(
    bodies: list[_Body], fused: _Fused, tolerance: float
) -> list[tuple[TopoDS_Shape | None, str]]:
    """What is shared, what overlapped, what was cut or lost."""
    kinds = (TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX)
    owners: Owners = {kind: ByShape() for kind in kinds}
    for number, body in enumerate(bodies):
        for image in fused.images(body.shape):
            for kind, met in owners.items():
                for shape in unique(image, kind):
                    met.setdefault(shape, {}).setdefault(number)
    found: list[tuple[TopoDS_Shape | None, str]] = [(None, _shared(owners, tolerance))]
    for piece, numbers in owners[TopAbs_SOLID].items():
        if len(numbers) > 1:
            names = " and ".join(repr(bodies[k].name) for k in numbers)
            found.append((piece, f"common to {names}, which overlap: a piece of its own"))
    for body in bodies:
        images = fused.images(body.shape)
        if body.is_solid and len(images) > 1:
            found.append((None, f"{body.name!r} was cut into {len(images)} solids"))
        lost = sum(not fused.images(face) for face in unique(body.shape, TopAbs_FACE))
        if lost:
            found.append((None, f"{counted(lost, 'face')} of {body.name!r} vanished"))
    return found


def _shared(owners: Owners, tolerance: float) -> str:
    """How much bodies have in common, as a sentence."""
    words = []
    for kind, one, many in (
        (TopAbs_FACE, "face", "faces"), (TopAbs_EDGE, "edge", "edges"),
        (TopAbs_VERTEX, "vertex", "vertices"),
    ):  # fmt: skip
        count = sum(len(numbers) > 1 for _, numbers in owners[kind].items())
        if count:
            words.append(counted(count, one, many))
    if not words:
        return f"imprinted: no two bodies touch within {tolerance:.2g} mm"
    return f"imprinted: bodies share {', '.join(words)}"
