"""A row of control points a hair apart is a pole; a degenerate edge that is long is none."""

import cadquery as cq
import numpy as np
import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeVertex
from OCP.Geom import Geom_BezierSurface
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TopoDS import TopoDS_Face, TopoDS_Wire

import surfmesh as sm
from surfmesh.geometry.cad_surfaces.elementary import Cone
from surfmesh.meshing.faces.face_data import CoedgeNodes, FaceJob, boundary_of
from surfmesh.meshing.faces.face_mesh import mesh_face
from surfmesh.sizing.options.sizing import Sizing


def triangle(width: float, size: float = 1000.0) -> cq.Face:
    """A Bezier patch over a triangle whose tip is ``width`` wide, between three straight edges that
    meet in the middle of it, without p-curves."""
    corners = [(-0.5 * size, 0.0), (0.5 * size, 0.0), (0.5 * width, size), (-0.5 * width, size)]
    net = TColgp_Array2OfPnt(1, 2, 1, 2)
    for place, (x, y) in zip(((1, 1), (2, 1), (2, 2), (1, 2)), corners):
        net.SetValue(*place, gp_Pnt(x, y, 0.0))
    ends = [gp_Pnt(*corners[0], 0.0), gp_Pnt(*corners[1], 0.0), gp_Pnt(0.0, size, 0.0)]
    vertices = [BRepBuilderAPI_MakeVertex(point).Vertex() for point in ends]
    builder, wire, face = BRep_Builder(), TopoDS_Wire(), TopoDS_Face()
    builder.MakeWire(wire)
    for k in range(3):
        builder.Add(wire, BRepBuilderAPI_MakeEdge(vertices[k], vertices[(k + 1) % 3]).Edge())
    wire.Closed(True)
    builder.MakeFace(face, Geom_BezierSurface(net), 1e-3)
    builder.Add(face, wire)
    return cq.Face(face)


@pytest.mark.parametrize("size", [1.0, 1000.0])
@pytest.mark.parametrize("fraction", [1.5e-4, 1e-5])
def test_edges_that_meet_in_a_pole_that_is_nearly_a_point(fraction, size):
    model = sm.from_cadquery(triangle(fraction * size, size))
    report = sm.check(sm.mesh(model, sm.Sizing(chord=1e-3 * size)))
    assert report.folded == 0
    assert not any("intersects" in problem for problem in report.problems)
    assert report.area == pytest.approx(0.5 * size**2, rel=1e-3)


def test_a_degenerate_edge_that_is_long_is_refused_with_its_place():
    """A band of a cone whose loop leaps by two turns along a circle that is no point."""
    band = Cone(
        (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), radius=10.0, angle=0.7,
        domain=((0.0, 2.0 * np.pi), (0.0, 3.0)),
    )  # fmt: skip

    def piece(uv, numbers, degenerate=False):
        uv = np.array(uv, float)
        points = band.evaluate(uv, 0)[0]
        points = np.tile(points[:1], (len(uv), 1)) if degenerate else points
        return CoedgeNodes(uv, np.array(numbers), points, np.ones(len(uv)), degenerate)

    loop = (
        piece([(-3.0, 0.0), (9.0, 0.0)], [0, 0], True),
        piece([(9.0, 0.0), (6.0, 0.0), (3.0, 0.0)], [0, 1, 2]),
        piece([(3.0, 0.0), (3.0, 3.0)], [2, 3]),
        piece([(3.0, 3.0), (0.0, 3.0), (-3.0, 3.0)], [3, 4, 5]),
        piece([(-3.0, 3.0), (-3.0, 0.0)], [5, 0]),
    )
    mesh = mesh_face(FaceJob(band, boundary_of((loop,)), Sizing(size=1.0)))
    assert "is to be one point" in mesh.failure
    assert "(-9.89992, -1.4112, 0)" in mesh.failure
