"""Tips and necks thinner than their triangles are long: as the model is, without a flood."""

import math
from itertools import pairwise

import cadquery as cq
import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol, BRepPrimAPI_MakeTorus
from OCP.Geom import Geom_BezierCurve
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt

import surfmesh as sm


def torus(major: float, minor: float, angle: float = 2.0 * math.pi) -> sm.CadModel:
    return sm.from_cadquery(cq.Shape.cast(BRepPrimAPI_MakeTorus(major, minor, angle).Shape()))


def revolved(polygon: list[tuple[float, float]], angle: float = 2.0 * math.pi) -> sm.CadModel:
    """A Bezier profile from the y axis to the y axis, turned about it."""
    poles = TColgp_Array1OfPnt(1, len(polygon))
    for k, (x, y) in enumerate(polygon):
        poles.SetValue(k + 1, gp_Pnt(float(x), float(y), 0.0))
    profile = cq.Shape.cast(BRepBuilderAPI_MakeEdge(Geom_BezierCurve(poles)).Edge())
    axis = cq.Edge.makeLine(cq.Vector(0, polygon[-1][1], 0), cq.Vector(0, polygon[0][1], 0))
    face = cq.Face.makeFromWires(cq.Wire.assembleEdges([profile, axis]))
    turn = gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0))
    return sm.from_cadquery(cq.Shape.cast(BRepPrimAPI_MakeRevol(face.wrapped, turn, angle).Shape()))


SPIKE = [(0, 0), (4, 0), (4, 5), (0, 5), (0, 9)]
"""Ends tangent to the axis: volume 97.1074, area 106.1358, by OCP's integration."""


@pytest.mark.parametrize(
    ("major", "euler", "most"),
    [(2.0, 1, 2400), (1.2, 2, 3400), (1.9999, 2, 2600), (2.0001, 0, 2400)],
)
def test_tori_that_reach_their_axis_are_closed(major, euler, most):
    model = torus(major, 2.0)
    mesh = sm.mesh(model, sm.Sizing(chord=0.05))
    report = sm.check(mesh)
    assert report.problems == ()
    assert report.closed
    assert report.euler == euler
    assert report.area == pytest.approx(model.area, rel=0.015)
    assert report.volume == pytest.approx(8.0 * math.pi**2 * major, rel=0.03)
    assert report.triangles < most


@pytest.mark.parametrize("scale", [1e-3, 1e3])
@pytest.mark.parametrize("angle", [1.0, 2.0 * math.pi])
def test_a_horn_torus_of_any_size_and_part(scale, angle):
    model = torus(2.0 * scale, 2.0 * scale, angle)
    report = sm.check(sm.mesh(model, sm.Sizing(chord=0.08 * scale)))
    assert report.clean
    assert report.volume == pytest.approx(8.0 * math.pi * angle * scale**3, rel=0.05)


@pytest.mark.parametrize(
    "sizing", [sm.Sizing(chord=0.1), sm.Sizing(size=0.5), sm.Sizing(size=0.6, anisotropy=5)]
)
def test_a_profile_tangent_to_its_axis_is_closed(sizing):
    model = revolved(SPIKE)
    report = sm.check(sm.mesh(model, sizing))
    assert report.problems == ()
    assert report.euler == 2
    assert report.volume == pytest.approx(97.1074, rel=0.06)
    assert report.area == pytest.approx(106.1358, rel=0.03)


@pytest.mark.parametrize("order", [3, 5])
def test_a_profile_of_high_contact_costs_no_flood(order):
    polygon = [(0, 0), (4, 0), *((0, 3 + k) for k in range(order))]
    report = sm.check(sm.mesh(revolved(polygon), sm.Sizing(chord=0.05)))
    assert report.clean
    assert report.triangles < 3000


def test_the_long_triangles_of_a_tip_stand_on_one_ring():
    """Six of them round the pole of a cusp, and no edge there shorter than needs be."""
    model = torus(2.0, 2.0)
    mesh = sm.mesh(model, sm.Sizing(chord=0.05))
    pole = int(np.argmin(np.linalg.norm(mesh.points, axis=1)))
    around = mesh.triangles[(mesh.triangles == pole).any(axis=1)]
    assert len(around) == 12  # six on each of the two fans
    rims = {
        frozenset(pair)
        for triangle in around.tolist()
        for pair in pairwise([*triangle, triangle[0]])
        if pole not in pair
    }
    assert len(rims) == 12


def test_a_horn_torus_of_splines_in_many_faces_meets_in_one_vertex():
    """Where its singular line is found by search, in each face over another box."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert

    shape = cq.Shape.cast(BRepPrimAPI_MakeTorus(2.0, 2.0).Shape())
    shape = shape.rotate(cq.Vector(0, 0, 0), cq.Vector(1, 1, 0), 33.0)
    model = sm.from_cadquery(cq.Shape.cast(BRepBuilderAPI_NurbsConvert(shape.wrapped).Shape()))
    assert model.broken_invariant() == ""
    report = sm.check(sm.mesh(model, sm.Sizing(chord=0.1)))
    assert report.clean
    assert report.euler == 1
    assert report.volume == pytest.approx(16.0 * math.pi**2, rel=0.05)


@pytest.mark.parametrize(
    ("half_length", "radius", "turn", "sizes"),
    [
        (1.0, 1.0, 30.0, {"chord": 0.02}),
        (1.0, 1.0, 30.0, {"chord": 0.01}),
        (1.0, 0.3, 29.0, {"chord": 0.003}),
        (5.0, 0.05, 45.0, {"chord": 0.003}),
        (1.0, 0.1, 45.0, {"angle": 20.0}),
    ],
)
def test_wedges_of_balls_and_lenses_keep_chord_and_angle_across(half_length, radius, turn, sizes):
    """Between two poles they were taken for thin tubes, of one triangle in 60 degrees however wide:
    up to 4 times the chord off, and turned by up to 49 degrees where 20 were asked for."""
    arc = cq.Workplane("XZ").moveTo(0, -half_length).threePointArc((radius, 0), (0, half_length))
    wedge = arc.close().revolve(turn, (0, 0, 0), (0, 1, 0))
    report = sm.mesh(wedge, **sizes).report
    assert report.clean, report.problems


def test_a_round_bend_of_a_pipe_keeps_the_chord():
    """The part of a ball in a sweep along a polygon with round transitions."""
    path = cq.Workplane("XZ").polyline([(0, 0), (0, 5), (4, 9)])
    report = sm.mesh(cq.Workplane().circle(0.7).sweep(path, transition="round"), chord=0.02).report
    assert report.clean, report.problems
