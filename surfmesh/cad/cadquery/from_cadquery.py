"""Shapes that live in this process: CadQuery, build123d, or OCP's own."""

from __future__ import annotations

from typing import Any

from surfmesh.cad.healing.joining import Joining
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.errors import CadError, SurfmeshError
from surfmesh.truth_value import truth_value


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
    millimetres; units: what they are wanted in. A list of such objects is an assembly. heal: faults
    of shapes are mended first, and said in ``healing``; False takes shapes as they are.

    imprint: bodies that touch share their faces, which keep the names of both; a number is how
    near touches (True: by rounding alone). sew: loose faces whose edges lie as near as this are
    joined, and closed shells of them become solids. Both in units of the model.

    Raises CadError when there is nothing to mesh in it, or OCP gives up.
    """
    from surfmesh.cad.cadquery.parts_of_objects import part_of
    from surfmesh.cad.conversion.model_of_parts import model_of
    from surfmesh.cad.sub_shapes import said_by

    heal, joining = truth_value("heal", heal, CadError), Joining.of(imprint, sew)
    source = f"{type(obj).__module__.split('.')[0]} {type(obj).__name__}"
    try:
        return model_of(part_of(obj), heal=heal, units=units, source=source, joining=joining)
    except SurfmeshError:
        raise
    except Exception as error:  # OCP's own exceptions have no common parent in Python
        raise CadError(f"OCP gave up on the {source}: {said_by(error)}") from error
