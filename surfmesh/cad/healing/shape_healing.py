"""Repair of what files get wrong, by OCP's shape healing; every change is put in words.

Only a part in which something is wrong is touched, and then a copy of it. What cannot be done
without is done always: curves in space, and the boundary of a face that comes without one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.BRepCheck import BRepCheck_Analyzer, BRepCheck_Status
from OCP.BRepLib import BRepLib
from OCP.BRepTools import BRepTools_ReShape
from OCP.GC import GC_MakeLine
from OCP.Geom import Geom_Plane, Geom_RectangularTrimmedSurface
from OCP.Precision import Precision
from OCP.ShapeAnalysis import ShapeAnalysis_ShapeTolerance
from OCP.ShapeBuild import ShapeBuild_ReShape
from OCP.ShapeExtend import ShapeExtend, ShapeExtend_MsgRegistrator
from OCP.ShapeFix import ShapeFix_Face, ShapeFix_Shape
from OCP.TopAbs import (
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_FORWARD,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_WIRE,
)
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import (
    TopoDS_Edge,
    TopoDS_Face,
    TopoDS_Shape,
    TopoDS_Wire,
)

from surfmesh.cad.healing.creases import creased, cut_along_creases
from surfmesh.cad.healing.sphere_poles import passed_poles, with_turned_spheres
from surfmesh.cad.healing.validity import is_valid
from surfmesh.cad.parts import Part
from surfmesh.cad.sub_shapes import below, box_diagonal, edges_of, faces_of, unique
from surfmesh.errors import CadError

LARGEST_GAP = 1e-4  # of the part's size: healing closes no wider gap, raises no tolerance further

# OCP's words -> ours, in what shape healing says
WORDS = {"Wires": "loops", "wires": "loops", "Wire": "loop", "wire": "loop", "pcurves": "p-curves"}
STILL = {
    BRepCheck_Status.BRepCheck_SelfIntersectingWire: "its boundary crosses itself",
    BRepCheck_Status.BRepCheck_IntersectingWires: "its loops cross each other",
    BRepCheck_Status.BRepCheck_NotClosed: "a loop is not closed",
    BRepCheck_Status.BRepCheck_NotConnected: "the edges of a loop do not meet",
    BRepCheck_Status.BRepCheck_NoCurveOnSurface: "an edge has no p-curve on it",
    BRepCheck_Status.BRepCheck_InvalidImbricationOfWires: "its loops are not inside each other",
    BRepCheck_Status.BRepCheck_InvalidCurveOnSurface: "an edge lies off it",
    BRepCheck_Status.BRepCheck_EmptyWire: "a loop has no edges",
    BRepCheck_Status.BRepCheck_RedundantEdge: "a loop uses an edge too often",
}


def healed(part: Part, heal: bool = True) -> Part:
    """The part made fit for use, with remarks; the same part when nothing is wrong.

    heal=False: only what cannot be done without. Raises CadError for a part without a shape.
    """
    if part.shape is None or part.shape.IsNull():
        raise CadError(f"the part {part.name!r} has no shape")
    bare = [face for face in faces_of(part.shape) if _is_bare(face)]
    curveless = [edge for edge in edges_of(part.shape) if _lacks_curve(edge)]
    passed = passed_poles(part) if heal else []
    wrong = heal and (_lacks_pcurve(part.shape) or not is_valid(part.shape))
    if not (bare or curveless or wrong or passed):
        return _uncreased(part) if heal else part
    part = _copied(part)
    if curveless or wrong:
        part = _with_curves(part)
    if bare:
        part = _with_boundaries(part)
    if passed:
        part = with_turned_spheres(part, passed_poles(part))
    if wrong:
        part = _repaired(_with_own_loops(part))
    elif passed:
        part = _with_faces_repaired(_with_own_loops(part))
    return _uncreased(part) if heal else part


def _uncreased(part: Part) -> Part:
    """Faces with creases inside are cut along them; the caller's shape is not touched."""
    if not creased(part):
        return part
    part = _copied(part)
    return cut_along_creases(part, creased(part))


def _copied(part: Part) -> Part:
    """A copy, because some of the tools work in place and the shape is the caller's."""
    copy = BRepBuilderAPI_Copy(part.shape)
    return part.mapped(
        lambda shape: copy.Shape() if shape.IsSame(part.shape) else copy.ModifiedShape(shape)
    )


def _with_curves(part: Part) -> Part:
    """Edges known only by their p-curves, or only by their vertices, get a curve in space."""
    remarks = list(part.remarks)
    for face in faces_of(part.shape):
        for edge in edges_of(face):
            if _is_no_point(edge):
                BRep_Builder().Degenerated(edge, False)
            if not _lacks_curve(edge):
                continue
            if BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0) is not None:
                if BRepLib.BuildCurve3d_s(edge):
                    text = "curve in space missing, made from a p-curve on a face"
                    remarks.append((edge, text))
            elif _is_plane(face) and _made_straight(edge):
                remarks.append((edge, "no curve at all, made straight"))
    return replace(part, remarks=remarks)


def _made_straight(edge: TopoDS_Edge) -> bool:
    """Give an edge between two vertices of a plane the line through them. In place."""
    ends = TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)
    if any(vertex.IsNull() for vertex in ends):
        return False
    first, last = (BRep_Tool.Pnt_s(vertex) for vertex in ends)
    length = first.Distance(last)
    if not BRep_Tool.Tolerance_s(edge) < length < Precision.Infinite_s():  # nor is it a number
        return False
    BRep_Builder().UpdateEdge(edge, GC_MakeLine(first, last).Value(), BRep_Tool.Tolerance_s(edge))
    BRep_Builder().Range(edge, 0.0, length)
    return True


def _with_boundaries(part: Part) -> Part:
    """Faces without loops (a whole sphere or torus) get the edges of their surface."""
    context = BRepTools_ReShape()
    remarks = list(part.remarks)
    for face in faces_of(part.shape):
        if not _is_bare(face):
            continue
        fix = ShapeFix_Face(face)
        if fix.FixAddNaturalBound():
            context.Replace(face, fix.Result())
            remarks.append((face, "no edges, natural boundary added"))
    return replace(part, remarks=remarks).mapped(context.Apply)


def _with_own_loops(part: Part) -> Part:
    """Of faces that share a loop and have no p-curves yet all but one get a copy of it.

    The edges at poles and the p-curves that they are given must not be those of the other side.
    """
    met: set[int] = set()
    again = []
    for face in faces_of(part.shape):
        if _is_plane(face):
            continue
        wires = {hash(wire) for wire in unique(face, TopAbs_WIRE)}
        if wires & met and not any(
            BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0) for edge in edges_of(face)
        ):
            again.append(face)
        met |= wires
    if not again:
        return part
    context = BRepTools_ReShape()
    for face in again:
        context.Replace(face, _on_a_copy(face))
    return part.mapped(context.Apply)


def _on_a_copy(face: TopoDS_Face) -> TopoDS_Face:
    """The same face with a surface and wires of its own, between the same edges."""
    builder, own = BRep_Builder(), TopoDS_Face()
    builder.MakeFace(own, BRep_Tool.Surface_s(face).Copy(), BRep_Tool.Tolerance_s(face))
    for wire in below(face):
        if wire.ShapeType() != TopAbs_WIRE:
            continue
        copy = TopoDS_Wire()
        builder.MakeWire(copy)
        for edge in below(wire):
            builder.Add(copy, edge)
        builder.Add(own, copy)
    return own


def _with_faces_repaired(part: Part) -> Part:
    """The faces that lack p-curves repaired, all others as they are: the tools drop seams of faces
    that are closed both ways. Where the part is not valid then, it is repaired as a whole."""
    context = ShapeBuild_ReShape()
    for face in faces_of(part.shape):
        if any(BRep_Tool.CurveOnSurface_s(e, face, 0.0, 0.0) is None for e in edges_of(face)):
            fix = ShapeFix_Shape(face)
            fix.SetContext(context)
            fix.SetMaxTolerance(_widest(part))
            fix.Perform()
    mended = part.mapped(context.Apply)
    return mended if is_valid(mended.shape) else _repaired(part)


def _widest(part: Part) -> float:
    """The tolerance up to which the tools may raise others."""
    known = ShapeAnalysis_ShapeTolerance().Tolerance(part.shape, 1)
    return max(LARGEST_GAP * box_diagonal([part.shape], exact=False), known)


def _repaired(part: Part) -> Part:
    ShapeExtend.Init_s()  # loads the texts of its messages
    fix = ShapeFix_Shape(part.shape)
    messages = ShapeExtend_MsgRegistrator()
    fix.SetMsgRegistrator(messages)
    fix.SetMaxTolerance(_widest(part))
    fix.Perform()
    context = fix.Context()
    said = messages.MapShape()  # some of it of shapes that are new
    remarks = [*part.remarks]
    for shape, text in (*_messages(part.shape, said), *_messages(fix.Shape(), said)):
        remarks.append((shape, text))
    spoken = {hash(context.Apply(shape)) for shape, _ in remarks if shape is not None}
    for face in faces_of(part.shape):
        new = context.Apply(face)
        if new.IsNull():
            remarks.append((None, "face removed"))
        elif not new.IsSame(face) and hash(new) not in spoken:
            remarks.append((face, _change(face, new, context)))
    whole = part.shape

    def new_of(shape: TopoDS_Shape) -> TopoDS_Shape:
        return fix.Shape() if shape.IsSame(whole) else context.Apply(shape)

    result = replace(part, remarks=remarks).mapped(new_of)
    after = list(_still_wrong(result.shape))
    if not after and len(result.remarks) == len(part.remarks):
        after = [(None, "made valid by wider tolerances")]
    return replace(result, remarks=result.remarks + after)


def _change(face: TopoDS_Face, new: TopoDS_Shape, context: BRepTools_ReShape) -> str:
    """What differs between a face and what became of it, where healing said nothing."""
    if new.ShapeType() != TopAbs_FACE:
        return "split"
    before = [context.Apply(edge) for edge in edges_of(face)]
    after = {hash(edge): edge for edge in edges_of(new.Oriented(TopAbs_FORWARD))}
    kept = [(edge, after[hash(edge)]) for edge in before if hash(edge) in after]
    if any(one.Orientation() != other.Orientation() for one, other in kept):
        return "loop orientation reversed"
    if len(after) > len(kept):
        return "edges added"
    if len(before) > len(kept):
        return "edges removed"
    old = {hash(edge) for edge in edges_of(face)}
    return "edges put in order" if old.issuperset(after) else "edges fitted anew"


def _messages(whole: TopoDS_Shape, said: Any) -> Iterator[tuple[TopoDS_Shape | None, str]]:
    """What was ``said`` (a map of OCP) of each face, its loops, edges, of shells and solids."""
    seen = set()
    for kind in (TopAbs_SOLID, TopAbs_SHELL):
        for shape in unique(whole, kind):
            yield from ((None, text) for text in _texts(shape, said))
    for face in faces_of(whole):
        for shape in (face, *unique(face, TopAbs_WIRE), *unique(face, TopAbs_EDGE)):
            if hash(shape) not in seen:
                seen.add(hash(shape))
                yield from ((face, text) for text in _texts(shape, said))


def _texts(shape: TopoDS_Shape, said: Any) -> Iterator[str]:
    if not said.IsBound(shape):
        return
    for message in said.Find(shape):
        text = re.sub(r" \d+(?= )", "", message.Value().ToExtString())
        text = re.sub(r"\w+", lambda word: WORDS.get(word[0], word[0]), text)
        yield text[:1].lower() + text[1:]


def _still_wrong(shape: TopoDS_Shape) -> Iterator[tuple[TopoDS_Shape, str]]:
    analyzer = BRepCheck_Analyzer(shape)
    if analyzer.IsValid():
        return
    for face in unique(shape, TopAbs_FACE):
        if analyzer.IsValid(face):
            continue
        reasons = dict.fromkeys(
            STILL[status]
            for part in (*unique(face, TopAbs_WIRE), face)
            for status in _statuses(analyzer, part, face)
            if status in STILL
        )
        if reasons:  # OCP also calls faces wrong that can be meshed: edges inside, no vertices
            yield face, f"not repaired: {' and '.join(reasons)}"


def _statuses(analyzer: BRepCheck_Analyzer, shape: TopoDS_Shape, within: TopoDS_Shape) -> list:
    result = analyzer.Result(shape)
    statuses = list(result.Status())
    result.InitContextIterator()
    while result.MoreShapeInContext():
        if result.ContextualShape().IsSame(within):
            statuses += list(result.StatusOnShape())
        result.NextShapeInContext()
    return statuses


def _is_bare(face: TopoDS_Face) -> bool:
    return not TopExp_Explorer(face, TopAbs_EDGE).More()


def _lacks_curve(edge: TopoDS_Edge) -> bool:
    return not BRep_Tool.Degenerated_s(edge) and BRep_Tool.Curve_s(edge, 0.0, 0.0) is None


def _is_no_point(edge: TopoDS_Edge) -> bool:
    """Marked as degenerate, and yet it runs from one vertex to another."""
    if not BRep_Tool.Degenerated_s(edge):
        return False
    first, last = TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)
    return not first.IsNull() and not last.IsNull() and not first.IsSame(last)


def _lacks_pcurve(shape: TopoDS_Shape) -> bool:
    """Whether an edge has no curve in (u, v) on a face where it cannot be made at once."""
    for face in faces_of(shape):
        if not _is_plane(face) and any(
            BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0) is None for edge in edges_of(face)
        ):
            return True
    return False


def _is_plane(face: TopoDS_Face) -> bool:
    surface = BRep_Tool.Surface_s(face)
    while isinstance(surface, Geom_RectangularTrimmedSurface):
        surface = surface.BasisSurface()
    return isinstance(surface, Geom_Plane)
