"""Every part is healed and scaled once, then put where the assembly wants it."""

from __future__ import annotations

from dataclasses import replace

from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.gp import gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape

from surfmesh.cad.healing.shape_healing import healed
from surfmesh.cad.healing.unusable_faces import without_unusable_faces
from surfmesh.cad.parts import Part
from surfmesh.cad.sub_shapes import compound_of

ROUND_OFF = 1e-9  # how far the scale of a placement may be from one


def placed(root: Part, heal: bool, scale: float) -> Part:
    """The tree healed, scaled and in place: all of it in one frame."""
    return _placed(root, TopLoc_Location(), heal, scale, [])


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
        met = next((done for shape, done in known if shape.IsEqual(part.shape)), None)
        ready = _scaled(_usable(part, heal), scale) if met is None else met
        if met is None:
            known.append((part.shape, replace(ready, remarks=[])))  # said once is enough
        ready = _moved(replace(ready, name=part.name, colour=part.colour), place, scale)
    children = [_placed(child, place, heal, scale, known) for child in part.children]
    return replace(ready, place=None, children=children)


def _usable(part: Part, heal: bool) -> Part:
    """Healed, without the faces that cannot be used; without a shape where all are such."""

    part = without_unusable_faces(part)
    if part.shape is not None and part.shape.IsNull():
        said = part.left_out or [f"the part {part.name!r} has no shape"]
        return replace(part, shape=None, details=[], remarks=[], tags=[], left_out=said)
    return healed(part, heal)


def _scaled(part: Part, scale: float) -> Part:
    if scale == 1.0 or part.shape is None:
        return part

    size = gp_Trsf()
    size.SetScale(gp_Pnt(0.0, 0.0, 0.0), scale)
    return _transformed(part, size)


def scaled_together(root: Part, scale: float) -> Part:
    """All parts of a tree at once, so that what they share stays shared."""
    if scale == 1.0:
        return root

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

    motion = gp_Trsf()
    motion.Multiply(place.Transformation())
    motion.SetTranslationPart(gp_Vec(motion.TranslationPart().Multiplied(scale)))
    if abs(motion.ScaleFactor() - 1.0) > ROUND_OFF:  # a mirror or a size: the geometry changes
        return _transformed(part, motion)
    where = place if scale == 1.0 else TopLoc_Location(motion)
    return part.mapped(lambda shape: shape.Moved(where))


def _transformed(part: Part, transformation: gp_Trsf) -> Part:

    change = BRepBuilderAPI_Transform(part.shape, transformation, True)
    whole = part.shape
    return part.mapped(
        lambda shape: change.Shape() if shape.IsSame(whole) else change.ModifiedShape(shape)
    )
