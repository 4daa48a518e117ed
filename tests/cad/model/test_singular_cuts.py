"""Faces with a singular point inside are cut there; areas and Euler numbers stay right."""

import math

import cadquery as cq
import numpy as np
import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone, BRepPrimAPI_MakeTorus

import surfmesh as sm
from surfmesh.cad.model.facts import euler_number


def torus(major: float, minor: float, angle: float = 2.0 * math.pi) -> sm.CadModel:
    return sm.from_cadquery(cq.Shape.cast(BRepPrimAPI_MakeTorus(major, minor, angle).Shape()))


def swept_area(major: float, minor: float) -> float:
    """The integral of 2 pi r |R + r cos v|."""
    cut = math.acos(-min(1.0, major / minor)) if minor >= major else math.pi
    outer = major * cut + minor * math.sin(cut)
    inner = minor * math.sin(cut) - major * (math.pi - cut)
    return 4.0 * math.pi * minor * (outer + inner)


@pytest.mark.parametrize(
    ("major", "faces", "euler"), [(2.0, 2, 1), (1.2, 3, 2), (0.3, 3, 2), (2.01, 1, 0)]
)
def test_a_torus_is_cut_where_it_meets_its_axis(major, faces, euler):
    model = torus(major, 2.0)
    assert model.broken_invariant() == ""
    assert len(model.faces) == faces
    assert model.area == pytest.approx(swept_area(major, 2.0), rel=1e-9)
    assert euler_number(model, range(faces)) == euler
    assert model.solids[0].closed
    assert {face for face, _ in model.solids[0].shells[0]} == set(range(faces))
    assert any("its surface is one point" in text for text in model.healing) == (faces > 1)


def test_neighbours_of_a_cut_face_get_the_vertex_too():
    """A wedge of a horn torus: its two planes share an edge that passes through the pinch."""
    model = torus(2.0, 2.0, 1.0)
    assert model.broken_invariant() == ""
    assert len(model.faces) == 4
    pinch = [k for k, vertex in enumerate(model.vertices) if np.linalg.norm(vertex.point) < 1e-9]
    assert len(pinch) == 1
    for face in model.faces:
        ends = {
            v for c in face.coedges for v in (model.edges[c.edge].start, model.edges[c.edge].end)
        }
        assert pinch[0] in ends


def test_a_double_cone_is_cut_at_its_apex():
    surface = cq.Shape.cast(BRepPrimAPI_MakeCone(1.0, 0.5, 1.0).Shape()).Faces()
    side = next(face for face in surface if face.geomType() == "CONE")
    from OCP.BRep import BRep_Tool
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace

    both = BRepBuilderAPI_MakeFace(
        BRep_Tool.Surface_s(side.wrapped), 0.0, 2.0 * math.pi, 0.0, 4.0, 1e-7
    ).Face()
    model = sm.from_cadquery(cq.Face(both))
    assert model.broken_invariant() == ""
    assert len(model.faces) == 2
    slant = math.sqrt(1.25)
    near, far = 2.0 * slant, 4.0 - 2.0 * slant
    sine = 0.5 / slant
    assert model.area == pytest.approx(math.pi * sine * (near**2 + far**2), rel=1e-9)
    report = sm.check(sm.mesh(model, sm.Sizing(chord=0.02)))
    assert report.folded == 0
    assert report.area == pytest.approx(model.area, rel=0.02)


def test_a_plain_model_is_left_as_it_is():
    model = sm.from_cadquery(cq.Workplane().sphere(1.0).union(cq.Workplane().box(1, 1, 3)))
    assert not any("one point" in text for text in model.healing)
