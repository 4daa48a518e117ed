"""Faces whose surface has creases inside are cut along them.

v |  ____c______        A spline whose degree in u is no higher than a knot is multiple may
  | |    |      |       have another normal on either side of u = c: a box rolled out, a
  | |  m | n    |       polygon drawn along a line. Without an edge of the mesh along c its
  | |____|______|       triangles cut the corner, and fold at any size.
  +------------- u
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_C0, GeomAbs_C1
from OCP.gp import gp_Pnt, gp_Vec
from OCP.Precision import Precision
from OCP.ShapeBuild import ShapeBuild_ReShape
from OCP.ShapeUpgrade import (
    ShapeUpgrade_FaceDivide,
    ShapeUpgrade_SplitSurface,
    ShapeUpgrade_SplitSurfaceContinuity,
)
from OCP.TColStd import TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_FORWARD
from OCP.TopoDS import TopoDS, TopoDS_Face

from surfmesh.cad.parts import Detail, Part
from surfmesh.cad.sub_shapes import unique

SHARP, BLUNT, FEW = math.radians(15.0), math.radians(5.0), 8
"""Normals on both sides that differ by less than SHARP, or BLUNT where a face has few such lines,
are left to the sizes: a finely drawn polygon is no set of faces."""

PLACES = 9  # along a line u = c or v = c
ASIDE = 1e-6  # of the box: so far from the line the normals are read


def creased(part: Part) -> list[TopoDS_Face]:
    """The faces of a part with a crease inside."""
    return [face for face in unique(part.shape, TopAbs_FACE) if _has_crease(TopoDS.Face_s(face))]


def cut_along_creases(part: Part, faces: list[TopoDS_Face]) -> Part:
    """The part with its creased ``faces`` cut, and their edges with them; names are kept."""
    context = ShapeBuild_ReShape()
    sharp = {hash(face) for face in faces}
    remarks = list(part.remarks)
    for shape in unique(part.shape, TopAbs_FACE):  # neighbours too: their edges are cut
        face = TopoDS.Face_s(shape.Oriented(TopAbs_FORWARD))
        divide = ShapeUpgrade_FaceDivide(face)
        divide.SetContext(context)
        tool = ShapeUpgrade_SplitSurface()
        if hash(shape) in sharp:
            tool = ShapeUpgrade_SplitSurfaceContinuity()
            tool.SetCriterion(GeomAbs_C1)
            tool.SetTolerance(Precision.Confusion_s())
        divide.SetSplitSurfaceTool(tool)
        if divide.Perform():
            context.Replace(face, divide.Result())
            if hash(shape) in sharp:
                remarks.append((face, "creases inside, cut along them"))
    done = replace(part, remarks=remarks).mapped(context.Apply)
    return replace(done, details=[piece for detail in done.details for piece in _pieces(detail)])


def _pieces(detail: Detail) -> Iterator[Detail]:
    """A face or an edge that was cut leaves its name and colour to all pieces."""
    yield detail
    for kind in (TopAbs_FACE, TopAbs_EDGE):
        if detail.shape.ShapeType() == kind - 1:  # a shell in the place of a face, a wire
            yield from (detail._replace(shape=shape) for shape in unique(detail.shape, kind))


def _has_crease(face: TopoDS_Face) -> bool:
    surface = BRepAdaptor_Surface(face)
    ways = (
        (surface.UContinuity, surface.NbUIntervals, surface.UIntervals),
        (surface.VContinuity, surface.NbVIntervals, surface.VIntervals),
    )
    box = (
        (surface.FirstUParameter(), surface.LastUParameter()),
        (surface.FirstVParameter(), surface.LastVParameter()),
    )
    for way, (continuity, number, intervals) in enumerate(ways):
        if continuity() != GeomAbs_C0:
            continue
        ends = TColStd_Array1OfReal(1, number(GeomAbs_C1) + 1)
        intervals(ends, GeomAbs_C1)  # read by a call: OCP 7.8 gives arrays no Value
        step = ASIDE * (box[way][1] - box[way][0])
        along = np.linspace(*box[1 - way], PLACES + 2)[1:-1]
        least = BLUNT if ends.Length() - 2 <= FEW else SHARP
        for place in range(2, ends.Length()):
            before, after = (
                _normals(surface, way, ends(place) + side, along) for side in (-step, step)
            )
            cosine = np.einsum("ij,ij->i", before, after)
            known = before.any(axis=1) & after.any(axis=1)
            if (cosine[known] < math.cos(least)).any():
                return True
    return False


def _normals(surface: BRepAdaptor_Surface, way: int, at: float, along: np.ndarray) -> np.ndarray:
    """Unit normals (n, 3) where one parameter is ``at``; zero where there is none."""
    found, point, ru, rv = [], gp_Pnt(), gp_Vec(), gp_Vec()
    for other in along:
        surface.D1(*((at, other) if way == 0 else (other, at)), point, ru, rv)
        normal = ru.Crossed(rv)
        known = normal.Magnitude() > Precision.Confusion_s() * (ru.SquareMagnitude())
        found.append(normal.Normalized().Coord() if known else (0.0, 0.0, 0.0))
    return np.array(found)
