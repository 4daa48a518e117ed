"""A judge of closed CAD meshes that shares no code with the mesher.

index topology, volume and area against OpenCASCADE's own integrals, edges that pierce triangles,
and the distance both ways between the mesh and a fine tessellation of the true shape.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pyvista
import shapely
import trimesh
from OCP.BRep import BRep_Tool
from OCP.BRepGProp import BRepGProp
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

FINE = 0.05  # of the chord: how far the tessellation that stands for the truth may lie off
ALLOWED = 1.06  # of the chord, with that
SAMPLES = 20_000
SAFETY = 1.5  # of what deviation explains of volume and area


class Verdict(NamedTuple):
    faults: tuple[str, ...]
    figures: dict[str, Any]


def judged(points: np.ndarray, triangles: np.ndarray, shape: Any, chord: float) -> Verdict:
    """What is wrong with a mesh of a solid, in words, and the figures."""
    faults = list(_topology(points, triangles))
    mesh = trimesh.Trimesh(points, triangles, process=False)
    volume, area = _contents(shape)
    explained = SAFETY * chord * area
    if abs(mesh.volume - volume) > explained + 1e-6 * volume:
        faults.append(f"volume {mesh.volume:.6g} of {volume:.6g}")
    if abs(mesh.area / area - 1.0) > 0.05:
        faults.append(f"area {mesh.area:.6g} of {area:.6g}")
    pierced = piercing(points, triangles)
    if pierced:
        faults.append(f"{pierced} edges pierce triangles")
    truth = _tessellated(shape, FINE * chord)
    there = _farthest(mesh, truth, chord)
    back = _farthest(truth, mesh, chord)
    for way, far in (("from mesh to surface", there), ("from surface to mesh", back)):
        if far > ALLOWED:
            faults.append(f"{far:.3g} chord {way}")
    figures = {
        "deviation": max(there, back), "to_surface": there, "to_mesh": back,
        "volume_error": mesh.volume / volume - 1.0, "area_error": mesh.area / area - 1.0,
    }  # fmt: skip
    return Verdict(tuple(faults), figures)


def _topology(points: np.ndarray, triangles: np.ndarray) -> list[str]:
    """Every edge runs once each way, no point is left over or doubled."""
    faults = []
    starts, ends = triangles.ravel(), triangles[:, (1, 2, 0)].ravel()
    forward, times = np.unique(starts * np.int64(len(points)) + ends, return_counts=True)
    backward = np.unique(ends * np.int64(len(points)) + starts)
    if (times > 1).any():
        faults.append(f"{int((times > 1).sum())} edges run twice one way")
    if not np.array_equal(forward, backward):
        faults.append(f"{len(np.setxor1d(forward, backward))} edges without a partner")
    if len(np.unique(triangles)) < len(points):
        faults.append("points of no triangle")
    if len(np.unique(points, axis=0)) < len(points):
        faults.append("points at one place")
    return faults


def piercing(points: np.ndarray, triangles: np.ndarray) -> int:
    """How many edges pass through the inside of a triangle that they share no corner with."""
    edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0)
    boxes = [(points[of].min(axis=1), points[of].max(axis=1)) for of in (edges, triangles)]
    flat = [shapely.box(*low[:, :2].T, *high[:, :2].T) for low, high in boxes]
    edge, near = shapely.STRtree(flat[1]).query(flat[0])
    (low, high), (bottom, top) = boxes
    close = (low[edge, 2] <= top[near, 2]) & (bottom[near, 2] <= high[edge, 2])
    close &= ~(triangles[near][:, :, None] == edges[edge][:, None, :]).any(axis=(1, 2))
    edge, near = edge[close], near[close]
    ends = points[edges[edge]]
    through = _passes(ends[:, 0], ends[:, 1], points[triangles[near]])
    return len(np.unique(edge[through]))


def _passes(p: np.ndarray, q: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(k,) do segments from p to q (k, 3) cross triangles (k, 3, 3), clear of rounding?"""
    a, b, c = np.moveaxis(corners, 1, 0)
    normal = np.cross(b - a, c - a)
    size = np.linalg.norm(normal, axis=1)
    above = np.einsum("ij,ij->i", normal, p - a), np.einsum("ij,ij->i", normal, q - a)
    small = 1e-9 * size * np.sqrt(size)
    crosses = (np.minimum(*above) < -small) & (np.maximum(*above) > small)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = p + (above[0] / (above[0] - above[1]))[:, None] * (q - p)
    at[~crosses] = 0.0
    for one, other in ((a, b), (b, c), (c, a)):
        side = np.einsum("ij,ij->i", np.cross(other - one, at - one), normal)
        crosses = crosses & (side > 1e-7 * size**2)
    return crosses


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
            corners = [made.Triangle(i + 1).Get() for i in range(made.NbTriangles())]
            triangles.append(np.array(corners) - 1 + count)
            count += made.NbNodes()
        explorer.Next()
    return trimesh.Trimesh(np.concatenate(points), np.concatenate(triangles), process=False)


def _farthest(start: trimesh.Trimesh, end: trimesh.Trimesh, chord: float) -> float:
    """Largest distance over the chord from samples of one to the other."""
    samples, _ = trimesh.sample.sample_surface(start, SAMPLES // 4, seed=1)
    more = start.triangles_center[: SAMPLES // 4], start.vertices[: SAMPLES // 4]
    cloud = pyvista.PolyData(np.concatenate([samples, *more]))
    away = cloud.compute_implicit_distance(pyvista.wrap(end))["implicit_distance"]
    return float(np.abs(away).max()) / chord
