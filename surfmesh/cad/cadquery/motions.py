"""By which motion one shape came out of another: a copy that is moved keeps its parts' order.

samples of all vertices, edges and faces of both, in order -> best rotation (Kabsch) and shift
all of them meet?  then that is the motion, else the shapes differ by more than their place
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.gp import gp_Pnt, gp_Trsf
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_VERTEX
from OCP.TopoDS import TopoDS, TopoDS_Shape

from surfmesh.cad.sub_shapes import unique
from surfmesh.geometry.boxes import diagonal

MEET = 1e-6
"""Relative to the extent: samples of a moved copy lie this near."""

_FRACTIONS = (0.1, 0.5, 0.8)
"""Of the ranges of parameters, where edges and faces are sampled."""

_KINDS = (TopAbs_VERTEX, TopAbs_EDGE, TopAbs_FACE)


def motion_between(before: TopoDS_Shape, after: TopoDS_Shape) -> gp_Trsf | None:
    """The rotation, shift or mirror from one to the other; None: they do not differ by one."""
    parts = [[unique(shape, kind) for kind in _KINDS] for shape in (before, after)]
    if any(len(first) != len(second) for first, second in zip(*parts)):
        return None
    old, new = (np.array(list(_samples(*every))) for every in parts)
    if old.shape != new.shape or len(old) < 3:
        return None
    centres = old.mean(axis=0), new.mean(axis=0)
    reach = MEET * diagonal(old)
    if np.abs(old - new).max() <= reach:
        return gp_Trsf()
    left, _, right = np.linalg.svd((new - centres[1]).T @ (old - centres[0]))
    for mirror in (1.0, -1.0):
        # two signs fit what lies in a plane: a rotation is preferred
        sign = mirror * np.sign(np.linalg.det(left) * np.linalg.det(right))
        turn = left @ np.diag([1.0, 1.0, sign]) @ right
        shift = centres[1] - turn @ centres[0]
        if np.abs(old @ turn.T + shift - new).max() <= reach:
            return _transformation(turn, shift)
    return None


def _samples(
    vertices: list[TopoDS_Shape], edges: list[TopoDS_Shape], faces: list[TopoDS_Shape]
) -> Iterator[tuple[float, float, float]]:
    """Of all vertices, edges and faces, in order."""
    for vertex in vertices:
        yield _triple(BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertex)))
    for edge in map(TopoDS.Edge_s, edges):
        if not BRep_Tool.Degenerated_s(edge):
            curve = BRepAdaptor_Curve(edge)
            first, last = curve.FirstParameter(), curve.LastParameter()
            for fraction in _FRACTIONS:
                yield _triple(curve.Value(first + fraction * (last - first)))
    for face in map(TopoDS.Face_s, faces):
        surface = BRepAdaptor_Surface(face, True)
        u0, u1 = surface.FirstUParameter(), surface.LastUParameter()
        v0, v1 = surface.FirstVParameter(), surface.LastVParameter()
        for fraction, other in zip(_FRACTIONS, _FRACTIONS[::-1]):
            yield _triple(surface.Value(u0 + fraction * (u1 - u0), v0 + other * (v1 - v0)))


def _triple(point: gp_Pnt) -> tuple[float, float, float]:
    return point.X(), point.Y(), point.Z()


def _transformation(turn: np.ndarray, shift: np.ndarray) -> gp_Trsf:
    found = gp_Trsf()
    rows = np.column_stack([turn, shift])
    found.SetValues(*(float(x) for x in rows.ravel()))
    return found
