"""OpenCASCADE's own tessellation, which shows shapes on a screen, as a mesh."""

from pathlib import Path

import numpy as np
from cad_measures import (
    clocks,
    own_vertices,
    shape_figures,
    solid_figures,
    spent,
    without_collapsed,
)
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepGProp import BRepGProp
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.GProp import GProp_GProps
from OCP.IGESControl import IGESControl_Reader
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED, TopAbs_SOLID
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from surfmesh.quality.measures.shape import shapes

ANGLE = 0.5  # radians between the facets of a curve


def shape_of(path: Path) -> TopoDS_Shape:
    """The shape of a file as it is, unhealed, in millimetres."""
    if path.suffix.lower() in (".brep", ".brp"):
        shape = TopoDS_Shape()
        BRepTools.Read_s(shape, str(path), BRep_Builder())
        return shape
    step = path.suffix.lower() in (".step", ".stp", ".p21")
    reader = STEPControl_Reader() if step else IGESControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    return reader.OneShape()


def measured(shape: TopoDS_Shape, chord: float) -> dict:
    """The mesh of ``shape`` and its figures; nodes are joined where coordinates are equal."""
    start = clocks()
    BRepMesh_IncrementalMesh(shape, chord, False, ANGLE, False)
    seconds = clocks() - start
    every = [triangles_of(face) for face in faces_of(shape)]
    explorer = TopExp_Explorer(shape, TopAbs_SOLID)
    solids = []
    while explorer.More():
        solids.append(_solid(explorer.Current()))
        explorer.Next()
    return {
        "faces": len(every),
        **shape_figures(shapes(joined(every))),
        "solids": solids,
        **spent(seconds),
        "failed": sum(not len(corners) for corners in every),
        "reasons": [],
    }


def faces_of(shape: TopoDS_Shape) -> list[TopoDS_Face]:
    """Each face once."""
    faces = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_FACE, faces)
    return [TopoDS.Face_s(faces.FindKey(k + 1)) for k in range(faces.Extent())]


def _solid(solid: TopoDS_Shape) -> dict:
    around, explorer = [], TopExp_Explorer(solid, TopAbs_FACE)
    while explorer.More():
        around.append(triangles_of(TopoDS.Face_s(explorer.Current())))
        explorer.Next()
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid, properties)
    mesh = joined(around)
    figures = solid_figures(mesh) if len(mesh.triangles) else {}
    return {**figures, "volume_exact": abs(properties.Mass())}


def joined(faces: list[np.ndarray]):
    """One mesh of triangles (k, 3, 3) that are given by the coordinates of their corners."""
    corners = np.concatenate([*faces, np.empty((0, 3, 3))]).reshape(-1, 3)
    points, number = np.unique(corners, axis=0, return_inverse=True)
    return own_vertices(points, without_collapsed(number.reshape(-1, 3)))


def triangles_of(face: TopoDS_Face) -> np.ndarray:
    """(k, 3, 3) corners in space, outwards; none when the face has no mesh."""
    place = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face, place)
    if mesh is None:
        return np.empty((0, 3, 3))
    move = place.Transformation()
    nodes = [mesh.Node(k + 1).Transformed(move) for k in range(mesh.NbNodes())]
    points = np.array([(node.X(), node.Y(), node.Z()) for node in nodes])
    corners = np.array([mesh.Triangle(k + 1).Get() for k in range(mesh.NbTriangles())]) - 1
    if face.Orientation() == TopAbs_REVERSED:
        corners = corners[:, ::-1]
    return points[corners]
