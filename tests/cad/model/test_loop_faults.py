"""Loops that no size can mend are refused at once, by name; those that finer cuts mend are not."""

import math

import cadquery as cq
import numpy as np
import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.BRepLib import BRepLib
from OCP.GCE2d import GCE2d_MakeSegment
from OCP.Geom import Geom_CylindricalSurface, Geom_Plane, Geom_SphericalSurface
from OCP.gp import gp_Ax3, gp_Pln, gp_Pnt2d
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Face, TopoDS_Vertex, TopoDS_Wire

import surfmesh as sm
from surfmesh.cad.model.loop_faults import exact_loops
from surfmesh.errors import MeshingError

BUILD = BRep_Builder()
BOX = [(0, 0), (15, 0), (15, 10), (0, 10)]
E = 0.00228
SLIT = [(0, -5), (-E, -5), (-7.5, -5), (-7.5, 5), (7.5, 5), (7.5, -5), (E, -5)]


def square(x, y, side):
    return [(x, y), (x, y + side), (x + side, y + side), (x + side, y)]


def circle(x, y, radius, corners=24):
    turns = -2.0 * np.pi * np.arange(corners) / corners
    return [(x + radius * math.cos(t), y + radius * math.sin(t)) for t in turns]


def spline_surface():
    rows = [
        [cq.Vector(x, y, 0.4 * math.sin(0.4 * x) * math.cos(0.5 * y)) for y in range(-4, 15, 3)]
        for x in range(-4, 20, 3)
    ]
    return BRep_Tool.Surface_s(cq.Face.makeSplineApprox(rows).wrapped)


SURFACES = {
    "plane": (lambda: Geom_Plane(gp_Pln()), lambda u, v: (u, v)),
    "cylinder": (lambda: Geom_CylindricalSurface(gp_Ax3(), 5.0), lambda u, v: (0.2 * u, v)),
    "sphere": (
        lambda: Geom_SphericalSurface(gp_Ax3(), 10.0),
        lambda u, v: (0.1 * u + 0.3, 0.1 * v - 0.5),
    ),
    "spline": (spline_surface, lambda u, v: (0.2 + 0.04 * u, 0.2 + 0.05 * v)),
}


def wire(surface, corners, scale):
    """Straight lines of (u, v) between the corners, as edges with vertices of their own."""
    vertices = []
    for corner in corners:
        vertices.append(TopoDS_Vertex())
        BUILD.MakeVertex(vertices[-1], surface.Value(*corner), 1e-7 * scale)
    found = TopoDS_Wire()
    BUILD.MakeWire(found)
    for k, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1])):
        line = GCE2d_MakeSegment(gp_Pnt2d(*a), gp_Pnt2d(*b)).Value()
        ends = vertices[k], vertices[(k + 1) % len(vertices)]
        edge = BRepBuilderAPI_MakeEdge(line, surface, *map(TopoDS.Vertex_s, ends)).Edge()
        BRepLib.BuildCurve3d_s(edge)
        BUILD.Add(found, edge)
    found.Closed(True)
    return found


def face_and_box(loops, kind="plane", scale=1.0):
    """A face with these loops, in no good order, beside a unit cube."""
    make, place = SURFACES[kind]
    surface, face = make(), TopoDS_Face()
    BUILD.MakeFace(face, surface, 1e-7 * scale)
    for loop in loops:
        corners = [place(scale * x, scale * y) for x, y in loop]
        BUILD.Add(face, wire(surface, corners, scale))
    both = TopoDS_Compound()
    BUILD.MakeCompound(both)
    BUILD.Add(both, face)
    cube = cq.Workplane().box(scale, scale, scale).translate((0, 0, 50 * scale))
    BUILD.Add(both, cube.val().wrapped)
    return sm.from_cadquery(cq.Shape.cast(both))


UNMENDABLE = {
    "coincides": (BOX, [(0, 10), (15, 10), (15, 0), (0.02, 0), (0, 0)]),
    "touches": (SLIT, [(0, -5), (-E, -5), (-5, 0), (-3, 3.6), (0, 4.9), (3, 3.6), (5, 0), (E, -5)]),
    "twice": (BOX, BOX[::-1]),
    "equal holes": (BOX, square(3, 3, 2), square(3, 3, 2)),
    "pokes through": (BOX, [(3, -1e-3), (3, 4), (8, 4), (8, -1e-3)]),
    "a point pokes through": (BOX, [(3, 2), (5, -0.01), (7, 2)][::-1]),
    "spike": ([(0, 0), (15, 0), (15, 5), (12, 5), (15, 5), (15, 10), (0, 10)],),
}


@pytest.mark.parametrize("sizing", [sm.Sizing(chord=0.02, max_size=2), sm.Sizing(size=1.0)])
@pytest.mark.parametrize("name", UNMENDABLE)
def test_what_no_size_can_mend_is_refused_by_name(name, sizing):
    model = face_and_box(UNMENDABLE[name])
    with pytest.raises(MeshingError, match=r"face 6 \(\w+\): its (edge|loop)") as refused:
        sm.mesh(model, sizing)
    assert "Lower the sizes" not in str(refused.value)
    mesh = sm.mesh(model, sizing, strict=False)
    assert set(mesh.face_ids.tolist()) == set(range(6))
    assert not sm.check(mesh).clean


@pytest.mark.parametrize("kind", ["cylinder", "sphere", "spline"])
@pytest.mark.parametrize("name", ["coincides", "pokes through"])
def test_on_other_surfaces_too(name, kind):
    model = face_and_box(UNMENDABLE[name], kind)
    with pytest.raises(MeshingError, match=r"face 6 \(\w+\): its (edge|loop)"):
        sm.mesh(model, sm.Sizing(chord=0.02, max_size=2))


@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-5])
@pytest.mark.parametrize("scale", [1e-2, 1.0, 1e2])
def test_loops_that_nearly_touch_are_meshed(gap, scale):
    for hole in ([(3, 2), (7, 2), (5, gap)], circle(5, 2 + gap, 2)):
        model = face_and_box((BOX, hole), scale=scale)
        mesh = sm.mesh(model, sm.Sizing(size=1.5 * scale))
        assert sm.check(mesh).clean
        assert len(mesh.triangles) < 1500


def test_an_edge_there_and_back_outside_the_face_is_said():
    """What healing makes of a torus that is drilled through its tube."""
    torus = cq.Workplane().add(cq.Solid.makeTorus(6, 2))
    shape = torus.cut(cq.Workplane("YZ").circle(0.8).extrude(20, both=True)).val()
    model = sm.from_cadquery(shape)
    assert not shape.isValid()
    heard = []
    with pytest.raises(MeshingError, match=r"face 0 \(torus\): its edge \d+ runs there and back"):
        sm.mesh(model, 1.0, progress=lambda *said: heard.append(said))
    assert len(heard) < 20  # no round of finer cuts: there were many, or had no end


@pytest.mark.parametrize(
    "shape",
    [
        cq.Workplane().sphere(1.0),
        cq.Workplane().cylinder(2.0, 1.0),
        cq.Workplane().add(cq.Solid.makeTorus(3, 1)),
        cq.Workplane().add(cq.Solid.makeCone(1.0, 0.0, 2.0)),
        cq.Workplane().box(4, 3, 2).edges().fillet(0.3).faces(">Z").workplane().hole(0.5),
    ],
)
def test_good_faces_have_no_fault(shape):
    model = sm.from_cadquery(shape)
    for exact in exact_loops(model):
        assert (exact.fault, exact.touch) == ("", "")


NESTED = {
    "hole in a hole": (BOX, square(3, 3, 4), square(4, 4, 2)),
    "island": (BOX, square(3, 3, 4), square(4, 4, 2)[::-1]),
    "all clockwise": (BOX[::-1], square(3, 3, 4), square(4, 4, 2)),
}


@pytest.mark.parametrize("kind", ["plane", "spline", "cylinder"])
@pytest.mark.parametrize("name", NESTED)
def test_loops_are_oriented_by_nesting(name, kind):
    model = face_and_box(NESTED[name], kind)
    right = face_and_box((BOX, square(3, 3, 4)), kind).faces[6].area
    right += face_and_box((square(4, 4, 2)[::-1],), kind).faces[6].area
    assert model.faces[6].area == pytest.approx(right, rel=1e-6)
    mesh = sm.mesh(model, 0.7)
    report = sm.check(mesh)
    assert report.clean
    assert report.area == pytest.approx(right + 6.0, rel=2e-3)
