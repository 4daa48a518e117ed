"""Parts and assemblies by name, as a reader hands them over, and how they become one model.

A part's shape lies in the part's own frame and may stand in many places: it is healed and
scaled once, then put where the assembly wants it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, NamedTuple

from surfmesh.errors import CadError

if TYPE_CHECKING:
    from OCP.gp import gp_Trsf
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Shape

    from surfmesh.cad.healing.joining import Joining
    from surfmesh.cad.model.cad_model import CadModel, Colour

MILLIMETRES = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1e3, "in": 25.4, "ft": 304.8}
ROUND_OFF = 1e-9  # how far the scale of a placement may be from one


class Detail(NamedTuple):
    """What is known of one solid, shell, face or edge of a part."""

    shape: TopoDS_Shape  # where it lies in the part
    name: str
    colour: Colour | None
    names: tuple[str, ...] = ()  # of all that it was made of, where those were several


class Tag(NamedTuple):
    """A tag of CadQuery and the parts of the final shape that it stands for."""

    name: str
    held: str  # what was tagged, in words: "2 faces"
    shapes: list[TopoDS_Shape]  # where they lie in the part


@dataclass
class Part:
    """A node of the assembly tree.

    shape: of a part, in its own frame; None for an assembly. place: of that frame in the
    parent's, None where they are the same. colour: of everything below that has none of its
    own. details: names and colours within the shape. remarks: what healing did, and to which
    sub-shape (None: the part). tags: what they select. notes: whole sentences about the parts
    below, with what each is about (None: all of them). left_out: what of it cannot be meshed.
    """

    name: str
    shape: TopoDS_Shape | None = None
    place: TopLoc_Location | None = None
    colour: Colour | None = None
    details: list[Detail] = field(default_factory=list)
    children: list[Part] = field(default_factory=list)
    remarks: list[tuple[TopoDS_Shape | None, str]] = field(default_factory=list)
    tags: list[Tag] = field(default_factory=list)
    notes: list[tuple[TopoDS_Shape | None, str]] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)

    def __iter__(self) -> Iterator[Part]:
        """This part and all below it."""
        yield self
        for child in self.children:
            yield from child

    def mapped(self, image: Callable[[TopoDS_Shape], TopoDS_Shape]) -> Part:
        """The part with every shape in it replaced; the places and the tree are as they were."""
        return replace(
            self,
            shape=image(self.shape),
            details=[d._replace(shape=image(d.shape)) for d in self.details],
            remarks=[(None if s is None else image(s), text) for s, text in self.remarks],
            tags=[tag._replace(shapes=[image(s) for s in tag.shapes]) for tag in self.tags],
        )


def model_of(
    root: Part, *, heal: bool, units: str | None = None, file_unit: str = "mm", source: str = "",
    joining: Joining | None = None, path: FilePath | None = None,
) -> CadModel:  # fmt: skip
    """Heal, scale and place every part, join them if asked to, and walk through all of them.

    Shapes are in millimetres; units: what the model is wanted in (None: millimetres). path: of
    the file they were read from. Raises CadError when a part cannot be used, or the parts cannot
    be joined.
    """
    from OCP.TopLoc import TopLoc_Location

    from surfmesh.cad.model.topology import cad_model

    unit = checked_unit(units)
    scale = 1.0 / MILLIMETRES[unit]
    if joining is None or not joining:
        placed = _placed(root, TopLoc_Location(), heal, scale, [])
    else:
        placed = _placed(root, TopLoc_Location(), heal, 1.0, [])
        placed = _scaled_together(joining.applied(placed, MILLIMETRES[unit]), scale)
    return cad_model(placed, heal=heal, unit=unit, file_unit=file_unit, source=source, path=path)


def checked_unit(units: str | None) -> str:
    """The name of a unit that is known; raises CadError for any other."""
    unit = "mm" if units is None else units
    if unit not in MILLIMETRES:
        raise CadError(f"the unit {units!r} is not known: use one of {', '.join(MILLIMETRES)}")
    return unit


def _placed(
    part: Part,
    place: TopLoc_Location,
    heal: bool,
    scale: float,
    known: list[tuple[TopoDS_Shape, Part]],
) -> Part:
    """place: of the parent in the whole; known: shapes that were met before, made ready."""
    if part.place is not None:
        place = place.Multiplied(part.place)
    ready = part
    if part.shape is not None:
        ready = next((done for shape, done in known if shape.IsEqual(part.shape)), None)
        if ready is None:
            ready = _scaled(_usable(part, heal), scale)
            known.append((part.shape, replace(ready, remarks=[])))  # said once is enough
        ready = _moved(replace(ready, name=part.name, colour=part.colour), place, scale)
    children = [_placed(child, place, heal, scale, known) for child in part.children]
    return replace(ready, place=None, children=children)


def _usable(part: Part, heal: bool) -> Part:
    """Healed, without the faces that cannot be used; without a shape where all are such."""
    from surfmesh.cad.healing.shape_healing import healed
    from surfmesh.cad.healing.unusable_faces import without_unusable_faces

    part = without_unusable_faces(part)
    if part.shape is not None and part.shape.IsNull():
        said = part.left_out or [f"the part {part.name!r} has no shape"]
        return replace(part, shape=None, details=[], remarks=[], tags=[], left_out=said)
    return healed(part, heal)


def _scaled(part: Part, scale: float) -> Part:
    if scale == 1.0 or part.shape is None:
        return part
    from OCP.gp import gp_Pnt, gp_Trsf

    size = gp_Trsf()
    size.SetScale(gp_Pnt(0.0, 0.0, 0.0), scale)
    return _transformed(part, size)


def _scaled_together(root: Part, scale: float) -> Part:
    """All parts of a tree at once, so that what they share stays shared."""
    if scale == 1.0:
        return root
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Pnt, gp_Trsf

    from surfmesh.cad.sub_shapes import compound_of

    size = gp_Trsf()
    size.SetScale(gp_Pnt(0.0, 0.0, 0.0), scale)
    whole = compound_of(part.shape for part in root if part.shape is not None)
    change = BRepBuilderAPI_Transform(whole, size, True)

    def scaled(part: Part) -> Part:
        ready = part if part.shape is None else part.mapped(change.ModifiedShape)
        notes = [(None if s is None else change.ModifiedShape(s), text) for s, text in part.notes]
        return replace(ready, notes=notes, children=[scaled(child) for child in part.children])

    return scaled(root)


def _moved(part: Part, place: TopLoc_Location, scale: float) -> Part:
    if place.IsIdentity() or part.shape is None:
        return part
    from OCP.gp import gp_Trsf, gp_Vec
    from OCP.TopLoc import TopLoc_Location

    motion = gp_Trsf()
    motion.Multiply(place.Transformation())
    motion.SetTranslationPart(gp_Vec(motion.TranslationPart().Multiplied(scale)))
    if abs(motion.ScaleFactor() - 1.0) > ROUND_OFF:  # a mirror or a size: the geometry changes
        return _transformed(part, motion)
    where = place if scale == 1.0 else TopLoc_Location(motion)
    return part.mapped(lambda shape: shape.Moved(where))


def _transformed(part: Part, transformation: gp_Trsf) -> Part:
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform

    change = BRepBuilderAPI_Transform(part.shape, transformation, True)
    whole = part.shape
    return part.mapped(
        lambda shape: change.Shape() if shape.IsSame(whole) else change.ModifiedShape(shape)
    )
