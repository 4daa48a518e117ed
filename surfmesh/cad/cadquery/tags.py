"""What tags of CadQuery stand for in the final shape, which later steps may have made anew.

tagged face   the very same in the final shape                 -> that one
              else, moved as the shape was moved since:
              final faces on the same surface that overlap it  -> those (a hole, a split, ...)
edges by their curves, vertices by their points, in the same way
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex, BRepBuilderAPI_Transform
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Pnt, gp_Pnt2d, gp_Trsf, gp_Vec
from OCP.ShapeAnalysis import ShapeAnalysis_Surface
from OCP.TopAbs import (
    TopAbs_COMPOUND,
    TopAbs_COMPSOLID,
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_IN,
    TopAbs_ON,
    TopAbs_ShapeEnum,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_VERTEX,
    TopAbs_WIRE,
)
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape

from surfmesh.cad.cadquery.motions import motion_between
from surfmesh.cad.parts import Tag
from surfmesh.cad.sub_shapes import Numbering, below, unique

COINCIDE = 1e-6
"""Of the diagonal: what is within it lies in the same place."""

GRIDS = (7, 25, 101)
"""Samples each way of the (u, v) box of a face, until enough lie within it."""

ENOUGH = 3
"""So many samples of one must lie on the other: a single one may be a crossing."""

ALONG = 21
"""Samples along an edge."""

PARALLEL = 1e-3
"""Sine of the angle between normals of what is one surface."""

_KINDS = (TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX)
_WHOLE = (TopAbs_COMPOUND, TopAbs_COMPSOLID, TopAbs_SOLID)
_PARTS = {TopAbs_SHELL: TopAbs_FACE, TopAbs_WIRE: TopAbs_EDGE, TopAbs_SOLID: TopAbs_FACE}


def tags_of(workplane: Any, shape: TopoDS_Shape) -> list[Tag]:
    """All tags of a Workplane that hold shapes, as they are found in its final ``shape``."""
    if not workplane.ctx.tags:
        return []
    final = _Final(shape)
    motions = _motions(workplane)
    found = []
    for name, tagged in workplane.ctx.tags.items():
        shapes = [v.wrapped for v in tagged.vals() if isinstance(_wrapped(v), TopoDS_Shape)]
        if shapes:
            motion = _since(tagged, motions)
            standing = [s for one in shapes for s in final.standing(one, motion)]
            found.append(Tag(name, _in_words(shapes), standing))
    return found


class _Final:
    """The final shape, and which of its parts stand for what was there before."""

    def __init__(self, shape: TopoDS_Shape) -> None:
        self.parts = {kind: Numbering([shape], kind) for kind in _KINDS}
        self.boxes: dict[TopAbs_ShapeEnum, list[Bnd_Box]] = {}
        self.tolerance = max(COINCIDE * _box(shape, 0.0).SquareExtent() ** 0.5, 1e-7)

    def standing(self, shape: TopoDS_Shape, motion: gp_Trsf) -> list[TopoDS_Shape]:
        """What stands for a shape; motion: of everything since it was tagged."""
        kind = shape.ShapeType()
        known = self.parts[kind].find(shape) if kind in self.parts else None
        if known is not None:
            return [self.parts[kind][known]]
        if kind not in (TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX):
            return self._of_parts(shape, motion)
        moved = shape
        if motion.Form().name != "gp_Identity":
            moved = BRepBuilderAPI_Transform(shape, motion, True).Shape()
        if kind not in self.boxes:
            self.boxes[kind] = [_box(part, self.tolerance) for part in self.parts[kind]]
        box = _box(moved, self.tolerance)
        near = [p for p, b in zip(self.parts[kind], self.boxes[kind]) if not box.IsOut(b)]
        same = {TopAbs_FACE: _same_face, TopAbs_EDGE: _same_edge, TopAbs_VERTEX: _same_vertex}
        return [part for part in near if same[kind](part, moved, self.tolerance)]

    def _of_parts(self, shape: TopoDS_Shape, motion: gp_Trsf) -> list[TopoDS_Shape]:
        """Of a shell, wire, compound, or of a solid that is not there any more: of its faces."""
        kind = _PARTS.get(shape.ShapeType())
        parts = below(shape) if kind is None else unique(shape, kind)
        return [found for part in parts for found in self.standing(part, motion)]


def _same_face(final: TopoDS_Shape, tagged: TopoDS_Shape, tolerance: float) -> bool:
    """Are they pieces of one surface that overlap?"""
    faces = TopoDS.Face_s(final), TopoDS.Face_s(tagged)
    kinds = {BRepAdaptor_Surface(face, False).GetType() for face in faces}
    if len(kinds) > 1:
        return False
    reach = max(tolerance, *(BRep_Tool.Tolerance_s(face) for face in faces))
    for one, other in (faces, faces[::-1]):
        there = _OnFace(other, reach)
        if sum(there.holds(*sample) for sample in _inner(one)) >= ENOUGH:
            return True
    return False


def _inner(face: TopoDS_Face) -> list[tuple[gp_Pnt, gp_Vec | None]]:
    """Points within a face with their normals (None where there is none)."""
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    inside = BRepTopAdaptor_FClass2d(face, 0.0)
    surface = BRepAdaptor_Surface(face, False)
    found: list[tuple[gp_Pnt, gp_Vec | None]] = []
    for count in GRIDS:
        for i in range(count):
            for j in range(count):  # askew, so that no row lies along what is symmetric
                u = u0 + (i + 0.5 + 0.31 * (j / count - 0.5)) / count * (u1 - u0)
                v = v0 + (j + 0.5 + 0.23 * (i / count - 0.5)) / count * (v1 - v0)
                if inside.Perform(gp_Pnt2d(u, v)) == TopAbs_IN:
                    found.append((surface.Value(u, v), _normal(surface, u, v)))
        if len(found) >= ENOUGH:
            break
    return found


class _OnFace:
    """Whether points lie within a face."""

    def __init__(self, face: TopoDS_Face, reach: float) -> None:
        self.nearest = ShapeAnalysis_Surface(BRep_Tool.Surface_s(face))
        self.inside = BRepTopAdaptor_FClass2d(face, 0.0)
        self.surface = BRepAdaptor_Surface(face, False)
        self.reach = reach

    def holds(self, point: gp_Pnt, normal: gp_Vec | None) -> bool:
        """Is the point within it, and its normal there parallel to ``normal``?"""
        if normal is None:
            return False
        uv = self.nearest.ValueOfUV(point, self.reach)
        if self.nearest.Gap() > self.reach:
            return False
        if self.inside.Perform(uv, True) not in (TopAbs_IN, TopAbs_ON):
            return False
        own = _normal(self.surface, uv.X(), uv.Y())
        return own is not None and normal.Crossed(own).Magnitude() <= PARALLEL


def _normal(surface: BRepAdaptor_Surface, u: float, v: float) -> gp_Vec | None:
    """Of length one; None where there is none."""
    along_u, along_v, point = gp_Vec(), gp_Vec(), gp_Pnt()
    surface.D1(u, v, point, along_u, along_v)
    across = along_u.Crossed(along_v)
    length = across.Magnitude()
    return across.Divided(length) if length > 0.0 else None


def _same_edge(final: TopoDS_Shape, tagged: TopoDS_Shape, tolerance: float) -> bool:
    """Are they pieces of one curve that overlap?"""
    edges = TopoDS.Edge_s(final), TopoDS.Edge_s(tagged)
    if any(BRep_Tool.Degenerated_s(edge) for edge in edges):
        return False
    if len({BRepAdaptor_Curve(edge).GetType() for edge in edges}) > 1:
        return False
    reach = max(tolerance, *(BRep_Tool.Tolerance_s(edge) for edge in edges))
    for one, other in (edges, edges[::-1]):
        curve = BRepAdaptor_Curve(one)
        first, last = curve.FirstParameter(), curve.LastParameter()
        fractions = ((k + 0.5) / ALONG for k in range(ALONG))
        points = (curve.Value(first + fraction * (last - first)) for fraction in fractions)
        if sum(_distance(_vertex(point), other) <= reach for point in points) >= ENOUGH:
            return True
    return False


def _same_vertex(final: TopoDS_Shape, tagged: TopoDS_Shape, tolerance: float) -> bool:
    a, b = (BRep_Tool.Pnt_s(TopoDS.Vertex_s(shape)) for shape in (final, tagged))
    return a.Distance(b) <= tolerance


def _distance(a: TopoDS_Shape, b: TopoDS_Shape) -> float:
    found = BRepExtrema_DistShapeShape(a, b)
    return found.Value() if found.IsDone() else float("inf")


def _vertex(point: gp_Pnt) -> TopoDS_Shape:
    return BRepBuilderAPI_MakeVertex(point).Vertex()


def _box(shape: TopoDS_Shape, gap: float) -> Bnd_Box:
    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box, False)
    box.Enlarge(gap)
    return box


def _motions(workplane: Any) -> list[tuple[Any, gp_Trsf]]:
    """The steps that led to a Workplane, the last first, each with all motion after it."""
    after = gp_Trsf()
    found: list[tuple[Any, gp_Trsf]] = []
    later: list[TopoDS_Shape] = []
    step = workplane
    while step is not None:
        solids = [v.wrapped for v in step.vals() if _is_whole(_wrapped(v))]
        if solids and later and len(solids) == len(later):
            steps = [motion_between(a, b) for a, b in zip(solids, later)]
            if steps[0] is not None:
                after = after.Multiplied(steps[0])
        if solids:
            later = solids
        found.append((step, after))
        step = step.parent
    return found


def _since(tagged: Any, motions: list[tuple[Any, gp_Trsf]]) -> gp_Trsf:
    """What has moved the shape after a step, or after the last one that it shares with others."""
    step = tagged
    while step is not None:
        for known, motion in motions:
            if known is step:
                return motion
        step = step.parent
    return gp_Trsf()


def _is_whole(shape: Any) -> bool:
    return isinstance(shape, TopoDS_Shape) and shape.ShapeType() in _WHOLE


def _wrapped(value: Any) -> Any:
    return getattr(value, "wrapped", None)


def _in_words(shapes: Iterable[TopoDS_Shape]) -> str:
    """ "1 face, 4 edges" """
    counts: dict[str, int] = {}
    for shape in shapes:
        kind = shape.ShapeType().name.removeprefix("TopAbs_").lower()
        counts[kind] = counts.get(kind, 0) + 1
    many = {"vertex": "vertices"}
    return ", ".join(
        f"{n} {kind if n == 1 else many.get(kind, kind + 's')}" for kind, n in counts.items()
    )
