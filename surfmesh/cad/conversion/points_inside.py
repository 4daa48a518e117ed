"""A vertex inside a face, where another body touches it in a point, gets a short edge.

Meshes have nodes along edges. An edge inside the face, from the vertex to a point that is nearer
to it than any other edge, makes a node of the vertex and asks for no size that is not there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.ShapeAnalysis import ShapeAnalysis_Surface
from OCP.TopAbs import TopAbs_INTERNAL, TopAbs_VERTEX
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Iterator, TopoDS_Vertex

from surfmesh.cad.model.cad_model import CadCoedge
from surfmesh.cad.model.invariants import FRACTIONS
from surfmesh.geometry.cad_surfaces.curve_on_surface import CurveOnSurface
from surfmesh.geometry.cad_surfaces.curves import CoreCurve, Line
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import norm

REACH = 0.4
"""Of the distance to the nearest edge or other vertex inside: that far the edge goes."""


@dataclass(frozen=True)
class ShortEdge:
    """From a vertex along u: curve in space, p-curve, both with parameters 0 to ``end``."""

    curve: CoreCurve
    pcurve: Line
    end: float
    length: float  # of its chord, in space


def vertices_inside(face: TopoDS_Face) -> list[TopoDS_Vertex]:
    """Vertices of a face that are on none of its edges."""
    found = []
    iterator = TopoDS_Iterator(face)
    while iterator.More():
        shape = iterator.Value()
        if shape.ShapeType() == TopAbs_VERTEX and shape.Orientation() == TopAbs_INTERNAL:
            found.append(TopoDS.Vertex_s(shape))
        iterator.Next()
    return found


def short_edges(
    face: TopoDS_Face, surface: FaceSurface, loops: Sequence[tuple[CadCoedge, ...]],
    vertices: Sequence[TopoDS_Vertex],
) -> list[ShortEdge | None]:  # fmt: skip
    """One for each of these vertices; None where it lies on an edge after all."""
    here = np.array([BRep_Tool.Pnt_s(vertex).Coord() for vertex in vertices])
    nearest = ShapeAnalysis_Surface(BRep_Tool.Surface_s(face))
    around = np.concatenate([coedge.uv(FRACTIONS) for loop in loops for coedge in loop])
    (edges,) = surface.evaluate(around, 0)
    found: list[ShortEdge | None] = []
    for number, vertex in enumerate(vertices):
        at = nearest.ValueOfUV(BRep_Tool.Pnt_s(vertex), BRep_Tool.Tolerance_s(vertex))
        uv = _within(np.array([at.X(), at.Y()]), surface)
        others = np.concatenate([edges, np.delete(here, number, axis=0)])
        room = float(np.linalg.norm(others - here[number], axis=1).min())
        tolerance = BRep_Tool.Tolerance_s(vertex)
        found.append(_along_u(surface, uv, REACH * room) if room > 4.0 * tolerance else None)
    return found


def _within(uv: np.ndarray, surface: FaceSurface) -> np.ndarray:
    """The same point in the (u, v) box of the face, where the surface comes round."""
    for axis, (low, high) in enumerate(surface.domain):
        period = surface.periods[axis]
        if period:
            uv[axis] -= period * np.ceil((uv[axis] - high) / period)
            uv[axis] += period * np.ceil((low - uv[axis]) / period)
    return uv


def _along_u(surface: FaceSurface, uv: np.ndarray, length: float) -> ShortEdge | None:
    r, r_u, _ = surface.evaluate(uv[None], 1)
    speed = norm(r_u[0])
    if not speed > 0.0:
        return None
    low, high = surface.domain[0]
    way = 1.0 if uv[0] - low < high - uv[0] else -1.0
    end = min(length / speed, 0.5 * (high - low))
    pcurve = Line(uv, np.array([way, 0.0]))
    if surface.kind == "plane":
        return ShortEdge(Line(r[0], way * r_u[0] / speed), pcurve, end, end * speed)
    curve = CurveOnSurface(surface, pcurve, 0.0, 1.0)
    first, last = curve.evaluate(np.array([0.0, end]), 0)[0]
    return ShortEdge(curve, pcurve, end, norm(last - first))
