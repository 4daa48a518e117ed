"""Whether OCP's checker finds nothing wrong with a shape.

    shape = solids, shells  +  ordinary faces  +  planes of very many loops
               |                  |                 |
            each by itself     all at once       its outer loop with some holes at a time, where
                                                 the boxes of all its holes are apart

The checker compares each loop of a face with each other one: two plates with 320 holes take longer
than the other thousand faces of a model. Loops of a plane whose boxes do not overlap neither cross
nor hold each other, so that they need not be compared. Where the shorter way finds something, the
whole shape is checked: what is said of it comes from there.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepCheck import BRepCheck_Analyzer, BRepCheck_Shell, BRepCheck_Solid, BRepCheck_Status
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_Plane
from OCP.TopAbs import (
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_FORWARD,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_WIRE,
)
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Face, TopoDS_Shape

from surfmesh.cad.sub_shapes import below, each, unique

AT_ONCE = 12
"""Edges of holes that are checked together, or as many as the outer loop has."""

SHORTER = 2.0
"""Pairs of edges of the whole face over those looked at in parts, for parts to be worth it."""

ROWS = 1000
"""Boxes that are compared with all others at a time."""


def is_valid(shape: TopoDS_Shape) -> bool:
    """What ``BRepCheck_Analyzer(shape).IsValid()`` says."""
    parts = {}
    for face in unique(shape, TopAbs_FACE):
        holes = _holes_in_groups(TopoDS.Face_s(face))
        if holes:
            parts[hash(face)] = holes
    if parts and not any(True for _ in each(shape, TopAbs_EDGE, TopAbs_FACE)):
        if _is_valid_in_parts(shape, parts):
            return True
    return bool(BRepCheck_Analyzer(shape).IsValid())


def _is_valid_in_parts(shape: TopoDS_Shape, parts: dict[int, list[TopoDS_Face]]) -> bool:
    """The same, if its solids, its shells and all faces are; parts: of faces, by their hash."""
    builder, others = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(others)
    for face in unique(shape, TopAbs_FACE):
        for part in parts.get(hash(face), [face]):
            builder.Add(others, part)
    if not BRepCheck_Analyzer(others).IsValid():
        return False
    for solid in unique(shape, TopAbs_SOLID):
        check = BRepCheck_Solid(TopoDS.Solid_s(solid))
        check.Minimum()
        if not _is_fine(check.Status()):
            return False
        for shell in unique(solid, TopAbs_SHELL):
            within = BRepCheck_Shell(TopoDS.Shell_s(shell))
            within.InContext(solid)
            within.InitContextIterator()
            if not (within.MoreShapeInContext() and _is_fine(within.StatusOnShape())):
                return False
    return all(
        _is_fine(BRepCheck_Shell(TopoDS.Shell_s(shell)).Status())
        for shell in unique(shape, TopAbs_SHELL)
    )


def _is_fine(statuses: object) -> bool:
    return all(status == BRepCheck_Status.BRepCheck_NoError for status in statuses)  # type: ignore[attr-defined]


def _holes_in_groups(face: TopoDS_Face) -> list[TopoDS_Face]:
    """A plane with its outer loop and some of its holes each; none where it is as well whole."""
    whole = TopoDS.Face_s(face.Oriented(TopAbs_FORWARD))
    wires = [wire for wire in below(whole) if wire.ShapeType() == TopAbs_WIRE]
    edges = [wire.NbChildren() for wire in wires]
    if sum(edges) <= 4 * AT_ONCE or not isinstance(BRep_Tool.Surface_s(face), Geom_Plane):
        return []
    outer = BRepTools.OuterWire_s(whole)
    holes = [(wire, n) for wire, n in zip(wires, edges) if not wire.IsSame(outer)]
    around = sum(edges) - sum(n for _, n in holes)
    at_once = max(AT_ONCE, around)
    looked_at = (1 + (sum(edges) - around) // at_once) * (at_once + around) ** 2
    if sum(edges) ** 2 < SHORTER * looked_at or not _are_apart([wire for wire, _ in holes]):
        return []
    return list(_groups(whole, outer, holes, at_once))


def _groups(
    face: TopoDS_Face, outer: TopoDS_Shape, holes: list[tuple[TopoDS_Shape, int]], at_once: int
) -> Iterator[TopoDS_Face]:
    builder, part, count = BRep_Builder(), None, 0
    for hole, edges in holes:
        if part is None:
            part, count = TopoDS.Face_s(face.EmptyCopied()), 0
            builder.Add(part, outer)
        builder.Add(part, hole)
        count += edges
        if count >= at_once:
            yield part
            part = None
    if part is not None:
        yield part


def _are_apart(wires: list[TopoDS_Shape]) -> bool:
    """Do no two boxes in space overlap, widened by the tolerances?"""
    corners = np.empty((len(wires), 6))
    for row, wire in zip(corners, wires):
        box = Bnd_Box()
        BRepBndLib.Add_s(wire, box, False)
        if box.IsVoid():
            return False
        row[:] = box.Get()
    low, high = corners[:, :3], corners[:, 3:]
    for k in range(0, len(wires), ROWS):
        at = slice(k, k + ROWS)
        overlap = ((low[at, None] <= high) & (low <= high[at, None])).all(axis=2)
        if overlap.sum() > len(low[at]):  # each box overlaps itself
            return False
    return True
