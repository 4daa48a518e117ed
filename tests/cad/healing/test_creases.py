"""A spline of degree one is a polygon: the faces drawn from it have creases inside."""

import cadquery as cq
import numpy as np
import pytest
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.Geom import Geom_BSplineCurve
from OCP.gp import gp_Pnt, gp_Vec
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

import surfmesh as sm


def polygon(corners: list[tuple[float, float]]):
    """One edge along all corners, back to the first: a spline of degree one."""
    count = len(corners) + 1
    points, knots = TColgp_Array1OfPnt(1, count), TColStd_Array1OfReal(1, count)
    times = TColStd_Array1OfInteger(1, count)
    for k in range(count):
        points.SetValue(k + 1, gp_Pnt(*corners[k % len(corners)], 0.0))
        knots.SetValue(k + 1, float(k))
        times.SetValue(k + 1, 2 if k in (0, count - 1) else 1)
    return BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(points, knots, times, 1)).Edge()


def drawn(corners: list[tuple[float, float]], height: float) -> cq.Shape:
    """A prism over a polygon, with one face all round."""
    wire = BRepBuilderAPI_MakeWire(polygon(corners)).Wire()
    face = BRepBuilderAPI_MakeFace(wire).Face()
    return cq.Shape.cast(BRepPrimAPI_MakePrism(face, gp_Vec(0.0, 0.0, height)).Shape())


L_SHAPE = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)]


@pytest.mark.parametrize("anisotropy", [1.0, 20.0])
def test_a_polygon_drawn_into_a_prism_has_an_edge_at_every_corner(anisotropy):
    model = sm.from_cadquery(drawn(L_SHAPE, 2.0))
    assert len(model.faces) == 8 and model.broken_invariant() == ""
    assert any("creases inside" in text for text in model.healing)
    mesh = sm.mesh(model, sm.Sizing(chord=0.01, anisotropy=anisotropy))
    report = sm.check(mesh)
    assert report.clean and report.folded == 0
    assert report.volume == pytest.approx(12.0, rel=1e-9)  # (4 + 2) x 2
    assert report.area == pytest.approx(2 * 6.0 + 14.0 * 2.0, rel=1e-9)


def test_the_shape_of_the_caller_keeps_its_faces():
    shape = drawn(L_SHAPE, 2.0)
    sm.from_cadquery(shape)
    assert len(shape.Faces()) == 3


def test_a_few_blunt_corners_are_edges():
    turn = np.radians([0.0, 10.0, 20.0, 30.0])
    shape = drawn([(np.cos(t), np.sin(t)) for t in turn] + [(0.0, 0.0)], 0.5)
    assert len(sm.from_cadquery(shape).faces) == 7


def test_many_are_left_to_the_sizes():
    turn = np.linspace(0.0, 2.0 * np.pi, 49)[:-1]  # 7.5 degrees each
    shape = drawn([(np.cos(t), np.sin(t)) for t in turn], 0.5)
    assert len(sm.from_cadquery(shape).faces) == 3
