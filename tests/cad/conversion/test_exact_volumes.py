"""Volumes of solids: faces are integrated each as exactly as it asks for."""

import numpy as np
import pytest

pytest.importorskip("OCP")

from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeSphere
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopoDS import TopoDS_Shape

from surfmesh.cad.conversion.model_of_parts import model_of
from surfmesh.cad.conversion.topology import EXACT
from surfmesh.cad.parts import Part
from surfmesh.cad.sub_shapes import content, each, unique, volume_within

RADIUS, LENGTH = 1.5, 8.0


def pipe(x: float, y: float, z: float) -> TopoDS_Shape:
    """A cylinder about the origin along (x, y, z)."""
    axis = np.array([x, y, z]) / np.linalg.norm([x, y, z])
    start = gp_Pnt(*(-0.5 * LENGTH * axis))
    return BRepPrimAPI_MakeCylinder(gp_Ax2(start, gp_Dir(*axis)), RADIUS, LENGTH).Shape()


def tee() -> TopoDS_Shape:
    """Two pipes that cross at right angles: p-curves of splines on both."""
    return BRepAlgoAPI_Fuse(pipe(1, 0, 0), pipe(0, 0, 1)).Shape()


def test_crossing_pipes_have_their_volume():
    """Both but for Steinmetz's solid, 16 r^3 / 3, which they have in common."""
    model = model_of(Part("tee", tee()), heal=True)
    exact = 2.0 * np.pi * RADIUS**2 * LENGTH - 16.0 / 3.0 * RADIUS**3
    kinds = {coedge.pcurve.kind for face in model.faces for coedge in face.coedges}
    assert "bspline" in kinds and model.volume == pytest.approx(exact, rel=1e-6)


def test_a_hollow_box_has_the_volume_of_its_shells():
    box = BRepPrimAPI_MakeBox(gp_Pnt(-5, -5, -5), gp_Pnt(5, 5, 5)).Shape()
    ball = BRepPrimAPI_MakeSphere(1.0).Shape()
    hollow = BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(box, ball).Shape(), pipe(1, 1, 9)).Shape()
    (solid,) = model_of(Part("box", hollow), heal=True).solids
    assert solid.volume == pytest.approx(content(hollow, 3, 1e-10), rel=1e-7)


@pytest.mark.parametrize("turned", [False, True])
def test_faces_make_up_the_volume_wherever_the_middle_is(turned):
    (solid,) = unique(tee(), TopAbs_SOLID)
    solid = solid.Reversed() if turned else solid
    faces = list(each(solid, TopAbs_FACE))
    whole = content(solid, 3, EXACT)
    assert (whole < 0.0) == turned
    for middle in ([0, 0, 0], [0.3, -0.2, 7.0]):
        found = volume_within(faces, [EXACT] * len(faces), middle)
        assert found == pytest.approx(whole, rel=1e-6)
