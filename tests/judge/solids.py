"""A judge of closed CAD meshes: volume and area against OpenCASCADE's own integrals, and the
distance both ways against a fine tessellation of the true shape."""

from __future__ import annotations

from typing import Any

import numpy as np
import trimesh
from OCP.BRep import BRep_Tool
from OCP.BRepGProp import BRepGProp
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.GProp import GProp_GProps
from OCP.TopAbs import (
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_REVERSED,
    TopAbs_ShapeEnum,
    TopAbs_VERTEX,
    TopAbs_WIRE,
)
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS
from OCP.TopTools import TopTools_IndexedMapOfShape

from judge.distances import farthest
from judge.index_topology import euler_number, faults_of_indices
from judge.orientation import reversed_triangles
from judge.piercing import folded, piercing
from judge.verdict import Verdict

FINE = 0.05  # of the chord: how far the tessellation that stands for the truth may lie off
ALLOWED = 1.06  # of the chord, with that
SAFETY = 1.5  # of what deviation explains of volume and area


def judged(
    points: np.ndarray, triangles: np.ndarray, shape: Any, chord: float, euler: int | None = None
) -> Verdict:
    """What is wrong with a mesh of a solid, in words, and the figures.

    euler: of the solid's surface, where it is known.
    """
    faults = faults_of_indices(points, triangles, closed=True)
    if euler is not None and euler_number(triangles) != euler:
        faults.append(f"Euler number {euler_number(triangles)} of {euler}")
    mesh = trimesh.Trimesh(points, triangles, process=False)
    volume, area = _contents(shape)
    explained = SAFETY * chord * area
    if abs(mesh.volume - volume) > explained + 1e-6 * volume:
        faults.append(f"volume {mesh.volume:.6g} of {volume:.6g}")
    elif mesh.volume < 0.0 < volume:
        faults.append("inside out")
    if abs(mesh.area / area - 1.0) > 0.05:
        faults.append(f"area {mesh.area:.6g} of {area:.6g}")
    for count, what in (
        (piercing(points, triangles), "edges pierce triangles"),
        (folded(points, triangles), "triangles lie folded on a neighbour"),
    ):
        if count:
            faults.append(f"{count} {what}")
    truth = _tessellated(shape, FINE * chord)
    against = reversed_triangles(mesh, truth, chord)
    if against:
        faults.append(f"{against} triangles look the wrong way")
    there, back = farthest(mesh, truth) / chord, farthest(truth, mesh) / chord
    for way, far in (("from mesh to surface", there), ("from surface to mesh", back)):
        if far > ALLOWED:
            faults.append(f"{far:.3g} chord {way}")
    figures = {
        "deviation": max(there, back), "to_surface": there, "to_mesh": back,
        "volume_error": mesh.volume / volume - 1.0, "area_error": mesh.area / area - 1.0,
    }  # fmt: skip
    return Verdict(tuple(faults), figures)


def euler_of(shape: Any) -> int:
    """V - E + F, less one for each further boundary of a face; loops that share a vertex are
    one boundary, degenerate edges none in space."""
    edges = [TopoDS.Edge_s(edge) for edge in _parts(shape, TopAbs_EDGE)]
    euler = len(_parts(shape, TopAbs_VERTEX)) - sum(not BRep_Tool.Degenerated_s(e) for e in edges)
    vertices = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_VERTEX, vertices)
    for face in _parts(shape, TopAbs_FACE):
        boundaries: list[set[int]] = []
        for wire in _parts(face, TopAbs_WIRE):
            met = {vertices.FindIndex(vertex) for vertex in _parts(wire, TopAbs_VERTEX)}
            for other in [one for one in boundaries if one & met]:
                boundaries.remove(other)
                met |= other
            boundaries.append(met)
        euler += 2 - len(boundaries)
    return euler


def _parts(shape: Any, kind: TopAbs_ShapeEnum) -> list[Any]:
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(k + 1) for k in range(found.Extent())]


def _contents(shape: Any) -> tuple[float, float]:
    found = []
    for integral in (BRepGProp.VolumeProperties_s, BRepGProp.SurfaceProperties_s):
        properties = GProp_GProps()
        integral(shape, properties)
        found.append(properties.Mass())
    return found[0], found[1]


def _tessellated(shape: Any, deflection: float) -> trimesh.Trimesh:
    """OpenCASCADE's triangles of all faces."""
    BRepMesh_IncrementalMesh(shape, deflection, False, 0.1, True)
    points, triangles, count = [], [], 0
    explorer = TopExp_Explorer(shape, TopAbs_FACE)
    while explorer.More():
        place = TopLoc_Location()
        made = BRep_Tool.Triangulation_s(TopoDS.Face_s(explorer.Current()), place)
        if made is not None:
            move = place.Transformation()
            nodes = (made.Node(i + 1).Transformed(move) for i in range(made.NbNodes()))
            points.append([(p.X(), p.Y(), p.Z()) for p in nodes])
            corners = np.array([made.Triangle(i + 1).Get() for i in range(made.NbTriangles())])
            if explorer.Current().Orientation() == TopAbs_REVERSED:
                corners = corners[:, ::-1]
            triangles.append(corners - 1 + count)
            count += made.NbNodes()
        explorer.Next()
    return trimesh.Trimesh(np.concatenate(points), np.concatenate(triangles), process=False)
