"""Spheres cut in two by a circle of two arcs, wherever it runs past the poles."""

import math
from itertools import pairwise

import cadquery as cq
import pytest
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Sewing,
)
from OCP.Geom import Geom_SphericalSurface
from OCP.gp import gp_Ax2, gp_Ax3, gp_Circ, gp_Dir, gp_Pnt
from OCP.TopoDS import TopoDS

import surfmesh as sm

R = 2.0


def halves(tilt: float, height: float, start: float) -> list[cq.Face]:
    """The two faces on either side of a circle whose plane is tilted, at a distance from the
    centre; its arcs begin at the angle ``start``."""
    normal = gp_Dir(math.sin(tilt), 0.0, math.cos(tilt))
    centre = gp_Pnt(normal.X() * height, 0.0, normal.Z() * height)
    circle = gp_Circ(gp_Ax2(centre, normal), math.sqrt(R * R - height * height))
    ends = start, start + math.pi, start + 2.0 * math.pi
    arcs = [BRepBuilderAPI_MakeEdge(circle, a, b).Edge() for a, b in pairwise(ends)]
    wire = BRepBuilderAPI_MakeWire(*arcs).Wire()
    surface = Geom_SphericalSurface(gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), R)
    wires = wire, TopoDS.Wire_s(wire.Reversed())
    return [cq.Face(BRepBuilderAPI_MakeFace(surface, way, False).Face()) for way in wires]


def sewn(faces: list[cq.Face]) -> cq.Shape:
    sewing = BRepBuilderAPI_Sewing(1e-6)
    for face in faces:
        sewing.Add(face.wrapped)
    sewing.Perform()
    return cq.Shape.cast(sewing.SewedShape())


PAST = {
    "through both poles": (math.pi / 2, 0.0),
    "a hair beside both": (math.pi / 2 - 1e-6, 0.0),
    "through one pole": (0.5, R * math.cos(0.5)),
    "a hair inside one": (0.5, R * math.cos(0.5 + 1e-7)),
    "a hair outside one": (0.5, R * math.cos(0.5 - 1e-4)),
    "round one pole": (0.2, 1.2),
    "round none": (1.4, 1.6),
}


@pytest.mark.parametrize("start", [0.0, 0.7])
@pytest.mark.parametrize("where", PAST)
def test_a_sphere_in_two_faces(where, start):
    tilt, height = PAST[where]
    faces = halves(tilt, height, start)
    exact = [2.0 * math.pi * R * (R - height), 2.0 * math.pi * R * (R + height)]
    for face, area in zip(faces, exact):
        report = sm.check(sm.mesh(sm.from_cadquery(face), sm.Sizing(chord=0.1)))
        assert report.clean
        assert report.area == pytest.approx(area, rel=0.06)
    model = sm.from_cadquery(sewn(faces))
    assert model.area == pytest.approx(sum(exact), rel=1e-6)
    report = sm.check(sm.mesh(model, sm.Sizing(chord=0.1)))
    assert report.clean
    assert report.closed
    assert report.euler == 2
    assert report.area == pytest.approx(sum(exact), rel=0.04)


def test_meridians_are_left_alone():
    octant = cq.Workplane().sphere(1.0, angle3=90.0)
    assert not sm.from_cadquery(octant).healing


@pytest.mark.parametrize("where", ["through both poles", "through one pole"])
def test_a_sphere_in_two_faces_comes_back_from_a_step_file(where, tmp_path):
    """The reader takes the face round the far side for the near one turned over."""
    tilt, height = PAST[where]
    path = tmp_path / "sphere.step"
    cq.exporters.export(cq.Workplane(obj=sewn(halves(tilt, height, 0.3))), str(path))
    report = sm.check(sm.mesh(sm.load(path), sm.Sizing(chord=0.1)))
    assert report.clean
    assert report.euler == 2
    assert report.area == pytest.approx(4.0 * math.pi * R * R, rel=0.04)


def test_other_faces_keep_their_seams():
    ring = cq.Solid.makeTorus(1.6, 0.87, cq.Vector(-2.45, 0.3, 0.1), cq.Vector(-0.2, 0.004, 1.0))
    hole = cq.Workplane(origin=(-3.46, -2.13, -0.94)).transformed(rotate=(32.0, 4.0, 0.0))
    part = cq.Workplane().box(3.47, 7.17, 3.88).union(cq.Workplane(obj=ring))
    part = part.cut(hole.circle(1.18).extrude(4.6))
    part = part.cut(cq.Workplane(origin=(0.78, 3.59, 2.65)).sphere(2.33))
    mesh = sm.mesh(part, sm.Sizing(chord=0.05))
    assert "passes a pole" in mesh.facts.healing[0]
    assert sm.check(mesh).clean
