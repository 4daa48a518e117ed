"""What CAD files get wrong, built on purpose: each case once left a hole or a bad mesh."""

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from naive.brep_euler import brep_euler
from scipy.interpolate import make_interp_spline

import surfmesh as sm
from surfmesh.cad.model.invariants import signed_area
from surfmesh.errors import MeshingError
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve
from surfmesh.meshing.faces import face_mesh, face_queue
from surfmesh.quality.measures.solids import solid_mesh


def crescent():
    """Between half a circle of radius 2 and half a one of radius 1 that touches it from inside."""
    outer = cq.Workplane().moveTo(2, 0).threePointArc((0, 2), (-2, 0)).lineTo(0, 0)
    return outer.threePointArc((1, 1), (2, 0)).close().extrude(1)


def with_bent_pcurves(model, number, bump, tolerance):
    """The p-curves of a face's arcs to the cusp at (2, 0) bent across each other near there."""
    face = model.faces[number]
    fraction = np.linspace(0.0, 1.0, 65)
    loops = []
    for loop in face.loops:
        bent = []
        for coedge in loop:
            uv = coedge.uv(fraction)
            points = face.surface.evaluate(uv, 0)[0]
            away = np.linalg.norm(points[:, :2] - (2.0, 0.0), axis=1)
            inner = abs(np.linalg.norm(points[32, :2] - (1.0, 0.0)) - 1.0) < 1e-6
            if inner and away.min() < 1e-9:
                push = points[:, :2] - (1.0, 0.0)
                push *= (bump * np.sin(np.pi * np.clip(away / 0.5, 0.0, 1.0)))[:, None]
                moved = points + np.concatenate([push, np.zeros((65, 1))], axis=1)
                uv = np.stack([(moved - face.surface.origin) @ face.surface.x,
                               (moved - face.surface.origin) @ face.surface.y], axis=1)  # fmt: skip
                spline = make_interp_spline(coedge.p0 + fraction * (coedge.p1 - coedge.p0), uv, k=3)
                coedge = replace(coedge, pcurve=BSplineCurve(spline.t, spline.c))
            bent.append(coedge)
        loops.append(tuple(bent))
    faces = list(model.faces)
    faces[number] = replace(face, loops=tuple(loops))
    edges = tuple(replace(edge, tolerance=tolerance) for edge in model.edges)
    return replace(model, faces=tuple(faces), edges=edges)


def test_pcurves_that_cross_at_a_cusp_leave_no_hole():
    model = sm.from_cadquery(crescent())
    number = next(k for k, f in enumerate(model.faces) if f.area == pytest.approx(1.5 * np.pi))
    bent = with_bent_pcurves(model, number, 0.02, 0.03)
    before, after = (signed_area(m.faces[number].loops[0], 200) for m in (model, bent))
    assert after < before - 1e-3
    mesh = sm.mesh(bent, sm.Sizing(chord=0.004))
    report = sm.check(mesh)
    assert report.closed and report.manifold and report.euler == 2
    assert report.volume == pytest.approx(1.5 * np.pi, rel=0.01)


def test_an_edge_that_is_a_polygon_keeps_its_corners():
    from OCP.BRepBuilderAPI import (
        BRepBuilderAPI_MakeEdge,
        BRepBuilderAPI_MakeFace,
        BRepBuilderAPI_MakeWire,
    )
    from OCP.Geom import Geom_BSplineCurve
    from OCP.gp import gp_Pnt
    from OCP.TColgp import TColgp_Array1OfPnt
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

    sides = 20
    angle = 2.0 * np.pi * np.arange(sides + 1) / sides
    poles = TColgp_Array1OfPnt(1, sides + 1)
    knots, times = TColStd_Array1OfReal(1, sides + 1), TColStd_Array1OfInteger(1, sides + 1)
    for k in range(sides + 1):
        poles.SetValue(k + 1, gp_Pnt(10.0 * np.cos(angle[k]), 10.0 * np.sin(angle[k]), 0.0))
        knots.SetValue(k + 1, float(k))
        times.SetValue(k + 1, 2 if k in (0, sides) else 1)
    edge = BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(poles, knots, times, 1)).Edge()
    face = BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(edge).Wire()).Face()
    model = sm.from_cadquery(cq.Shape.cast(face))
    mesh = sm.mesh(model, sm.Sizing(chord=0.05))
    exact = 0.5 * sides * 100.0 * np.sin(2.0 * np.pi / sides)
    assert model.area == pytest.approx(exact)
    perimeter = sides * 20.0 * np.sin(np.pi / sides)
    assert sm.check(mesh).area == pytest.approx(exact, abs=0.05 * perimeter)


def test_a_border_is_cut_as_finely_as_the_inside_asks():
    """A bump in the middle, flat along the border: sizes grow from the bump to the border."""
    side = np.linspace(-3.0, 3.0, 41)
    points = [
        [cq.Vector(x, y, 1.2 * np.exp(-6.0 * (x**2 + (y + 2.0) ** 2))) for x in side] for y in side
    ]
    model = sm.from_cadquery(cq.Face.makeSplineApprox(points, tol=1e-3))
    mesh = sm.mesh(model, sm.Sizing(chord=0.005, max_size=3.0))
    length = np.linalg.norm(np.diff(mesh.points[mesh.edge_segments], axis=1)[:, 0], axis=1)
    assert (length <= 2.0 * mesh.sizes[mesh.edge_segments].mean(axis=1)).all()
    assert sm.check(mesh).alpha_min > 0.45


def test_mistakes_of_ours_are_called_so(monkeypatch):
    def broken(*_, **__):
        raise IndexError("no such slot")

    monkeypatch.setattr(face_mesh, "_made", broken)
    monkeypatch.setattr(face_queue.CoreFaces, "face", lambda *_: None)
    with pytest.raises(MeshingError, match=r"internal error, please report .* slot"):
        sm.mesh(cq.Workplane().box(1, 1, 1), 0.5)


def hollow():
    return cq.Workplane().box(4, 4, 4).cut(cq.Workplane().sphere(1)).union(
        cq.Workplane().center(6, 0).circle(2).circle(1).extrude(1)
    )  # fmt: skip


SOLIDS = {
    "hollow box and washer": hollow,
    "pole": lambda: cq.Workplane().sphere(2),
    "apex": lambda: cq.Workplane().add(cq.Solid.makeCone(2, 0, 3)),
    "seams": lambda: cq.Workplane().add(cq.Solid.makeTorus(3, 1)),
    "cusp": crescent,
    "holes": lambda: cq.Workplane().box(9, 9, 1).faces(">Z").workplane().rarray(3, 3, 2, 2).hole(1),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_euler_number_is_that_of_the_brep(name):
    model = sm.from_cadquery(SOLIDS[name]())
    mesh = sm.mesh(model, sm.Sizing(chord=0.03))
    for number in range(len(model.solids)):
        solid = solid_mesh(mesh, number)
        vertices = len(np.unique(solid.triangles))
        euler = vertices - len(solid.edges) + len(solid.triangles)
        assert euler == brep_euler(model, number)


def test_a_solid_that_touches_itself_is_named():
    """Two boxes that share an edge are one solid by name, and no manifold."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Shell, TopoDS_Solid

    boxes = [cq.Solid.makeBox(1, 1, 1), cq.Solid.makeBox(1, 1, 1, cq.Vector(1, 1, 0))]
    build, shell, solid = BRep_Builder(), TopoDS_Shell(), TopoDS_Solid()
    build.MakeShell(shell)
    for face in boxes[0].fuse(boxes[1]).Faces():
        build.Add(shell, face.wrapped)
    build.MakeSolid(solid)
    build.Add(solid, shell)
    model = sm.from_cadquery(cq.Shape.cast(solid), heal=False)
    assert any("touches itself along edge" in said for said in model.healing), model.healing


def test_a_thin_strip_gets_triangles_of_its_own_width():
    """A step of 0.03 round a boss on a plate of diagonal 93, narrower than what sizes follow,
    but not narrower than the chord."""
    plate = cq.Workplane().rect(80, 48).extrude(2).faces(">Z").workplane().rect(4, 4).extrude(1)
    model = sm.from_cadquery(plate.faces(">Z").workplane().rect(3.94, 3.94).extrude(1))
    thin = [k for k, face in enumerate(model.faces) if face.area < 0.5]
    mesh = sm.mesh(model, sm.Sizing(chord=0.02))
    assert thin and sm.check(mesh).closed
    strip = np.isin(mesh.face_ids, thin)
    a, b, c = mesh.points[mesh.triangles[strip]].transpose(1, 0, 2)
    sides = np.stack([b - a, c - b, a - c], axis=1)
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    alpha = 4.0 * np.sqrt(3.0) * area / np.square(sides).sum(axis=(1, 2))
    assert (alpha < 0.3).mean() < 0.01


def test_edges_that_end_beside_their_vertex_get_no_segment_without_length():
    start, end = cq.Vector(0.0, 0.0, 0.0), cq.Vector(4.0, 0.0, 0.0)
    beside = cq.Vector(2e-8, 0.0, 0.0)  # one vertex with the start, within its tolerance
    above = cq.Vector(4.0, 0.08, 0.0)
    sides = [
        cq.Edge.makeLine(start, end),
        cq.Edge.makeLine(above, end),
        cq.Edge.makeThreePointArc(beside, cq.Vector(2.0, 0.02, 0.0), above),
    ]
    mesh = sm.mesh(cq.Face.makeFromWires(cq.Wire.assembleEdges(sides)), sm.Sizing(size=0.2))
    assert sm.check(mesh).clean
    lengths = np.linalg.norm(np.diff(mesh.points[mesh.edges], axis=1)[:, 0], axis=1)
    assert lengths.min() > 1e-6
