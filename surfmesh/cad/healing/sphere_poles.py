"""Spheres are turned where an edge passes a pole: there its p-curve in (u, v) leaps by half a turn.

v |  |    |             A circle that passes a pole, or goes by it within a hair, has a p-curve
  |  |    |   edge      of two lines that run up to v = pi / 2 and down again. Programs join
  |   \\__/             them to one loop round the wrong side. With the poles of the sphere
  +-------- u           away from all edges the p-curve is a plain curve.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepTools import BRepTools_ReShape
from OCP.Geom import Geom_SphericalSurface
from OCP.GeomAbs import GeomAbs_Sphere
from OCP.gp import gp_Ax3, gp_Dir, gp_Sphere
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Wire

from surfmesh.cad.parts import Part
from surfmesh.cad.sub_shapes import each, edges_of, faces_of
from surfmesh.geometry.small_matrices import product

NEAR = 0.02  # radians from a pole: an edge that comes so near passes it
MERIDIAN = 1e-9  # of the radius: an edge within this of a plane through the axis does not
SAMPLES = 65  # of an edge
DIRECTIONS = 400  # tried for the new axis


def passed_poles(part: Part) -> list[TopoDS_Face]:
    """The spherical faces of a part with an edge that passes a pole, and is no meridian."""
    return [face for face in faces_of(part.shape) if _passes(face)]


def with_turned_spheres(part: Part, faces: list[TopoDS_Face]) -> Part:
    """The part with these faces on spheres whose poles lie apart from their edges.

    They have no p-curves of their edges then: healing makes them.
    """
    context = BRepTools_ReShape()
    remarks = list(part.remarks)
    others = _turned_inside(part.shape, faces)
    for face in faces:
        if any(face.IsSame(other) for other in others):
            context.Replace(face, _on_turned_sphere(face, True).Reversed())
            remarks.append((face, "was its neighbour turned over: made the rest of its sphere"))
            continue
        context.Replace(face, _on_turned_sphere(face))
        remarks.append((face, "an edge passes a pole of its sphere, which is turned"))
    return replace(part, remarks=remarks).mapped(context.Apply)


def _turned_inside(shape: TopoDS_Shape, faces: list[TopoDS_Face]) -> list[TopoDS_Face]:
    """Faces that are another one of the shape turned over: between the same edges, on one sphere.

    Readers make that of the larger face where they take its loop to run round the smaller one.
    """
    used = map(TopoDS.Face_s, each(shape, TopAbs_FACE))
    uses = [face for face in used if any(face.IsSame(one) for one in faces)]
    ahead = [face for face in uses if face.Orientation() == TopAbs_FORWARD]
    back = [face for face in uses if face.Orientation() == TopAbs_REVERSED]
    return [face for face in back if any(_are_twins(face, other) for other in ahead)]


def _are_twins(one: TopoDS_Face, other: TopoDS_Face) -> bool:
    """Do two uses of faces run along the same edges, each in opposite directions?

    Turned over they would then be one: the faces on both sides of a loop run along it both ways.
    """
    first = [TopoDS.Face_s(face.Oriented(TopAbs_FORWARD)) for face in (one, other)]
    mine, others = (_real_edges(face) for face in first)
    same = len(mine) == len(others) and all(
        any(edge.IsEqual(another) for another in others) for edge in mine
    )
    if not same:
        return False
    spheres = [_sphere(face) for face in first]
    apart = spheres[0].Location().Distance(spheres[1].Location())
    return max(apart, abs(spheres[0].Radius() - spheres[1].Radius())) < BRep_Tool.Tolerance_s(one)


def _sphere(face: TopoDS_Face) -> gp_Sphere:
    return BRepAdaptor_Surface(face, False).Sphere()


def _real_edges(face: TopoDS_Face) -> list[TopoDS_Edge]:
    """The edges of a face, oriented as used, without degenerate ones and seams."""
    edges = [TopoDS.Edge_s(edge) for edge in each(face, TopAbs_EDGE)]
    uses = [sum(edge.IsSame(other) for other in edges) for edge in edges]
    return [
        edge for edge, count in zip(edges, uses)
        if count == 1 and not BRep_Tool.Degenerated_s(edge)
        and edge.Orientation() in (TopAbs_FORWARD, TopAbs_REVERSED)
    ]  # fmt: skip


def _directions(edge: TopoDS_Edge, sphere: gp_Sphere) -> np.ndarray:
    """(SAMPLES, 3) from the centre, of unit length, in the frame of the sphere."""
    curve, place = BRepAdaptor_Curve(edge), sphere.Position()
    axes = (place.XDirection(), place.YDirection(), place.Direction())
    frame = np.array([[a.X(), a.Y(), a.Z()] for a in axes])
    centre = np.array(sphere.Location().Coord())
    at = np.linspace(curve.FirstParameter(), curve.LastParameter(), SAMPLES)
    points = np.array([curve.Value(float(t)).Coord() for t in at])
    return product(points - centre, frame.T) / sphere.Radius()


def _passes(face: TopoDS_Face) -> bool:
    if BRepAdaptor_Surface(face, False).GetType() != GeomAbs_Sphere:
        return False
    sphere = _sphere(face)
    for edge in _real_edges(face):
        if BRep_Tool.Curve_s(edge, 0.0, 0.0) is None:
            return False
        way = _directions(edge, sphere)
        beside = np.hypot(way[:, 0], way[:, 1])
        step = np.linalg.norm(np.diff(way, axis=0), axis=1).max()
        if beside.min() > NEAR + step:
            continue
        flat = np.linalg.svd(way[:, :2], compute_uv=False)[-1] / np.sqrt(SAMPLES)
        if _least_beside(way) < NEAR and (flat > MERIDIAN or _lacks_pcurve(face)):
            return True
    return False


def _lacks_pcurve(face: TopoDS_Face) -> bool:
    """Of an edge at a pole, say, that it shares with a face on the other side."""
    return any(BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0) is None for edge in edges_of(face))


def _least_beside(way: np.ndarray) -> float:
    """Distance of the polygon from the axis."""
    start, step = way[:-1, :2], np.diff(way[:, :2], axis=0)
    square = np.maximum(np.einsum("ij,ij->i", step, step), np.finfo(float).tiny)
    fraction = np.clip(-np.einsum("ij,ij->i", start, step) / square, 0.0, 1.0)
    return float(np.linalg.norm(start + fraction[:, None] * step, axis=1).min())


def _on_turned_sphere(face: TopoDS_Face, other_side: bool = False) -> TopoDS_Face:
    """other_side: with its loops run the other way, which is the rest of the sphere."""
    sphere = _sphere(face)
    edges = _real_edges(face)
    if other_side:
        edges = [TopoDS.Edge_s(edge.Reversed()) for edge in edges]
    way = np.concatenate([_directions(edge, sphere) for edge in edges])
    axis = _axis_apart(way)
    place = sphere.Position()
    axes = (place.XDirection(), place.YDirection(), place.Direction())
    x, y, z = product(axis, np.array([[a.X(), a.Y(), a.Z()] for a in axes]))
    turned = gp_Ax3(sphere.Location(), gp_Dir(float(x), float(y), float(z)))
    if not place.Direct():
        turned.YReverse()
    builder, own = BRep_Builder(), TopoDS_Face()
    builder.MakeFace(
        own, Geom_SphericalSurface(turned, sphere.Radius()), BRep_Tool.Tolerance_s(face)
    )
    for loop in _loops(edges):
        wire = TopoDS_Wire()
        builder.MakeWire(wire)
        for edge in loop:
            builder.Add(wire, edge)
        wire.Closed(True)
        builder.Add(own, wire)
    return own


def _axis_apart(way: np.ndarray) -> np.ndarray:
    """The direction (3,) that is farthest, both ways, from directions (n, 3)."""
    k = np.arange(DIRECTIONS) + 0.5
    height, angle = 1.0 - k / DIRECTIONS, k * np.pi * (3.0 - 5.0**0.5)
    beside = np.sqrt(1.0 - height**2)
    tried = np.stack([beside * np.cos(angle), beside * np.sin(angle), height], axis=1)
    return tried[np.abs(product(tried, way.T)).max(axis=1).argmin()]


def _loops(edges: list[TopoDS_Edge]) -> list[list[TopoDS_Edge]]:
    """Edges one after the other, loop by loop."""
    left, loops = list(edges), []
    while left:
        loop = [left.pop(0)]
        home = TopExp.FirstVertex_s(loop[0], True)
        while not TopExp.LastVertex_s(loop[-1], True).IsSame(home):
            end = TopExp.LastVertex_s(loop[-1], True)
            ways = [e for e in left if TopExp.FirstVertex_s(e, True).IsSame(end)]
            if not ways:
                break
            left = [e for e in left if not e.IsEqual(ways[0])]
            loop.append(ways[0])
        loops.append(loop)
    return loops
