"""Shapes that live in this process: CadQuery, build123d, or OCP's own."""

from __future__ import annotations

import sys
from typing import Any

from surfmesh.cad.assembly import Detail, Part, model_of
from surfmesh.cad.healing.joining import Joining
from surfmesh.cad.model.cad_model import CadModel, Colour
from surfmesh.errors import CadError, SurfmeshError


def from_cadquery(
    obj: Any,
    heal: bool = True,
    units: str | None = None,
    *,
    imprint: bool | float = False,
    sew: float | None = None,
) -> CadModel:
    """The model of a Workplane, Shape, Sketch or Assembly, a build123d object, a TopoDS_Shape.

    A Workplane gives the solids and faces on its stack, and its tags as names: of what they held,
    or of what stands for it where later steps have cut, split or moved it. Lengths are taken as
    millimetres; units: what they are wanted in. A list of such objects is an assembly.

    imprint: bodies that touch share their faces, which keep the names of both; a number is how
    near touches (True: by rounding alone). sew: loose faces whose edges lie as near as this are
    joined, and closed shells of them become solids. Both in units of the model.

    Raises CadError when there is nothing to mesh in it, or OCP gives up.
    """
    joining = Joining.of(imprint, sew)
    source = f"{type(obj).__module__.split('.')[0]} {type(obj).__name__}"
    try:
        return model_of(_part(obj), heal=heal, units=units, source=source, joining=joining)
    except SurfmeshError:
        raise
    except Exception as error:  # OCP's own exceptions have no common parent in Python
        reason = f"{type(error).__name__} {error}".strip()
        raise CadError(f"OCP gave up on the {source}: {reason}") from error


def _part(obj: Any) -> Part:
    if isinstance(obj, (list, tuple)):
        return Part("assembly", children=[_part(item) for item in obj])
    cadquery = sys.modules.get("cadquery")  # whoever holds such an object has imported it
    if cadquery is not None:
        if isinstance(obj, cadquery.Assembly):
            return _assembly(obj)
        if isinstance(obj, cadquery.Workplane):
            return _workplane(obj)
        if isinstance(obj, cadquery.Sketch):
            faces = [face.moved(place).wrapped for place in obj.locs for face in obj._faces]
            return Part("sketch", _together(faces, "Sketch"))
    shape = getattr(obj, "wrapped", obj)
    if not _is_shape(shape):
        raise CadError(
            f"a {type(obj).__name__} has no faces to mesh: give a Workplane, Shape, Sketch, "
            "Assembly, or an object whose .wrapped is a TopoDS_Shape"
        )
    # build123d: label and color, also of the children that its compound is made of
    details = [
        Detail(child.wrapped, getattr(child, "label", ""), _colour(getattr(child, "color", None)))
        for child in getattr(obj, "children", ())
        if _is_shape(getattr(child, "wrapped", None))
    ]
    label = getattr(obj, "label", "") or type(obj).__name__.lower()
    return Part(str(label), shape, None, _colour(getattr(obj, "color", None)), details)


def _workplane(workplane: Any) -> Part:
    from surfmesh.cad.cadquery.tags import tags_of

    shapes = [value.wrapped for value in workplane.vals() if _has_faces(value)]
    if not shapes:  # edges or points are selected: what they are selected from
        try:
            shapes = [workplane.findSolid().wrapped]
        except (ValueError, AttributeError):
            shapes = []
    whole = _together(shapes, "Workplane")
    tags = tags_of(workplane, whole)
    details = [Detail(shape, tag.name, None) for tag in tags for shape in tag.shapes]
    return Part("workplane", whole, details=details, tags=tags)


def _assembly(assembly: Any) -> Part:
    """A node with its own shape is a part of that name beside its children."""
    shapes = [shape.wrapped for shape in assembly.shapes if _has_faces(shape)]
    colour = _colour(assembly.color)
    place = assembly.loc.wrapped
    names = getattr(assembly, "_subshape_names", None) or {}
    colours = getattr(assembly, "_subshape_colors", None) or {}
    details = [
        Detail(shape.wrapped, names.get(shape, ""), _colour(colours.get(shape)))
        for shape in dict.fromkeys([*names, *colours])
    ]
    children = [_assembly(child) for child in assembly.children]
    whole = _together(shapes, assembly.name) if shapes else None
    tags = []
    if whole is not None and hasattr(assembly.obj, "ctx"):  # a Workplane
        from surfmesh.cad.cadquery.tags import tags_of

        tags = tags_of(assembly.obj, whole)
    return Part(
        assembly.name,
        whole,
        None if place.IsIdentity() else place,
        colour,
        details,
        children,
        tags=tags,
    )


def _together(shapes: list, name: str) -> Any:
    """One shape, or a compound of several."""
    if not shapes:
        raise CadError(f"the {name} holds no solid and no face: nothing to mesh")
    if len(shapes) == 1:
        return shapes[0]
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound


def _is_shape(obj: Any) -> bool:
    from OCP.TopoDS import TopoDS_Shape

    return isinstance(obj, TopoDS_Shape)


def _has_faces(obj: Any) -> bool:
    from OCP.TopAbs import TopAbs_FACE
    from OCP.TopExp import TopExp_Explorer

    shape = getattr(obj, "wrapped", None)
    return _is_shape(shape) and TopExp_Explorer(shape, TopAbs_FACE).More()


def _colour(colour: Any) -> Colour | None:
    """Of a CadQuery or build123d colour."""
    wrapped = getattr(colour, "wrapped", None)
    if wrapped is None:
        return None
    from surfmesh.cad.reading.readers import screen_colour

    return screen_colour(wrapped.GetRGB())
