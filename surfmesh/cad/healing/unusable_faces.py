"""Faces that cannot be meshed, whatever the sizes, by name, place and reason.

They are taken out before anything else is done with a part: most tools of OCP crash on them.
"""

from __future__ import annotations

from dataclasses import replace

from OCP.BRep import BRep_Tool
from OCP.BRepTools import BRepTools_ReShape
from OCP.Geom import Geom_Plane
from OCP.Precision import Precision
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face

from surfmesh.cad.parts import Part, face_in_words
from surfmesh.cad.sub_shapes import Numbering, counted, unique


def without_unusable_faces(part: Part) -> Part:
    """The part without its faces that have no surface, no end, or edges without curves.

    ``left_out`` says which they were and why. The same part where there are none.
    """
    if part.shape is None or part.shape.IsNull():
        return part
    context = BRepTools_ReShape()
    said = []
    faces = Numbering([part.shape], TopAbs_FACE)
    for face in faces:
        reason = _reason(TopoDS.Face_s(face), part)
        if reason:
            said.append(f"{face_in_words(face, part, faces)}: {reason}")
            context.Remove(face)
    if not said:
        return part
    kept = part.mapped(lambda shape: shape if shape.IsNull() else context.Apply(shape))
    return replace(
        kept,
        details=[detail for detail in kept.details if not detail.shape.IsNull()],
        remarks=[(s, text) for s, text in kept.remarks if s is None or not s.IsNull()],
        left_out=[*part.left_out, *said],
    )


def _reason(face: TopoDS_Face, part: Part) -> str:
    """Why a face is of no use; empty for most."""
    surface = BRep_Tool.Surface_s(face)
    if surface is None:
        mesh = BRep_Tool.Triangulation_s(face, TopLoc_Location())
        held = counted(mesh.NbTriangles(), "triangle") if mesh is not None else "nothing"
        return f"it has no surface, but {held}; export it as a surface, not as triangles"
    edges = [TopoDS.Edge_s(edge) for edge in unique(face, TopAbs_EDGE)]
    if not edges and not all(map(_is_finite, surface.Bounds())):
        return "it has no edges, and its surface goes on to infinity; trim it in the CAD system"
    for edge in edges:
        is_known = BRep_Tool.Curve_s(edge, 0.0, 0.0) is not None
        if not all(map(_is_finite, BRep_Tool.Range_s(edge))):
            return "an edge of it goes on to infinity; trim it in the CAD system"
        if not (is_known or BRep_Tool.Degenerated_s(edge) or _can_be_made(edge, face, part)):
            return "an edge of it has no curve, neither in space nor on a face; draw it anew"
    return ""


def _is_finite(number: float) -> bool:
    return abs(number) < Precision.Infinite_s()


def _can_be_made(edge: TopoDS_Edge, face: TopoDS_Face, part: Part) -> bool:
    """Can healing find a curve for an edge: from a p-curve on any face, or straight on a plane?"""
    if isinstance(BRep_Tool.Surface_s(face), Geom_Plane):
        ends = TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)
        if not any(vertex.IsNull() for vertex in ends) and not ends[0].IsSame(ends[1]):
            return True
    return any(
        BRep_Tool.CurveOnSurface_s(edge, TopoDS.Face_s(other), 0.0, 0.0) is not None
        for other in unique(part.shape, TopAbs_FACE)
        if any(edge.IsSame(own) for own in unique(other, TopAbs_EDGE))
    )
