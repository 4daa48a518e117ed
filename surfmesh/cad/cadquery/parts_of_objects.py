"""Objects of CadQuery and build123d -> parts: what each of them calls a name, a colour, a place."""

from __future__ import annotations

import sys
from typing import Any

from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS_Shape

from surfmesh.cad.cadquery.tags import tags_of
from surfmesh.cad.model.cad_model import Colour
from surfmesh.cad.parts import Detail, Part, screen_colour
from surfmesh.cad.sub_shapes import compound_of, each
from surfmesh.errors import CadError


def part_of(obj: Any) -> Part:
    """The tree of parts that an object stands for; raises CadError where it has no faces."""
    if isinstance(obj, (list, tuple)):
        return Part("assembly", children=[part_of(item) for item in obj])
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
    if not isinstance(shape, TopoDS_Shape):
        raise CadError(
            f"a {type(obj).__name__} has no faces to mesh: give a Workplane, Shape, Sketch, "
            "Assembly, or an object whose .wrapped is a TopoDS_Shape"
        )
    # build123d: label and color, also of the children that its compound is made of
    details = [
        Detail(child.wrapped, getattr(child, "label", ""), _colour(getattr(child, "color", None)))
        for child in getattr(obj, "children", ())
        if isinstance(getattr(child, "wrapped", None), TopoDS_Shape)
    ]
    label = getattr(obj, "label", "") or type(obj).__name__.lower()
    return Part(str(label), shape, None, _colour(getattr(obj, "color", None)), details)


def _workplane(workplane: Any) -> Part:
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


def _together(shapes: list[TopoDS_Shape], name: str) -> TopoDS_Shape:
    """One shape, or a compound of several."""
    if not shapes:
        raise CadError(f"the {name} holds no solid and no face: nothing to mesh")
    return shapes[0] if len(shapes) == 1 else compound_of(shapes)


def _has_faces(obj: Any) -> bool:
    shape = getattr(obj, "wrapped", None)
    return isinstance(shape, TopoDS_Shape) and any(True for _ in each(shape, TopAbs_FACE))


def _colour(colour: Any) -> Colour | None:
    """Of a CadQuery or build123d colour."""
    wrapped = getattr(colour, "wrapped", None)
    return None if wrapped is None else screen_colour(wrapped.GetRGB())
