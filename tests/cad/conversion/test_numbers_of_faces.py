"""Faces whose geometry is no number to compute with are refused by name when they are read."""

import math
import warnings

import cadquery as cq
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BezierSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt, gp_Sphere
from OCP.TColgp import TColgp_Array2OfPnt

import surfmesh as sm
from surfmesh.errors import CadError


def bezier(y: float) -> cq.Face:
    """A patch one of whose four poles is (2, y, 1)."""
    poles = TColgp_Array2OfPnt(1, 2, 1, 2)
    for row, column, *place in ((1, 1, 0, 0, 0), (1, 2, 0, 1, 0), (2, 1, 2, y, 1), (2, 2, 2, 1, 1)):
        poles.SetValue(row, column, gp_Pnt(*map(float, place)))
    return cq.Face(BRepBuilderAPI_MakeFace(Geom_BezierSurface(poles), 1e-7).Face())


def sphere(x: float, radius: float) -> cq.Face:
    axes = gp_Ax3(gp_Pnt(x, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))
    return cq.Face(BRepBuilderAPI_MakeFace(gp_Sphere(axes, radius)).Face())


@pytest.mark.parametrize(
    ("face", "said"),
    [
        (bezier(math.nan), r"face .*: the pole \(2, nan, 1\) is not finite"),
        (bezier(1e308), r"face .*: .*the pole \(2, 1e\+308, 1\) is too far away"),
        (sphere(math.nan, 1.0), "face .*: its sphere is given by numbers that are not finite"),
        (sphere(1e300, 1.0), "face .*: its sphere has points too far away"),
        (sphere(0.0, 1e200), "face .*: its sphere has points too far away"),
    ],
    ids=["nan pole", "far pole", "nan centre", "far centre", "huge radius"],
)
def test_a_face_that_is_no_number_is_refused_by_name(face, said):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(CadError, match=said):
            sm.from_cadquery(face)


def test_the_other_faces_are_meshed_where_that_is_wanted():
    both = cq.Compound.makeCompound([bezier(math.nan), cq.Solid.makeBox(1, 1, 1)])
    mesh = sm.mesh(both, 0.5, strict=False)
    assert len(mesh.surfaces) == 6 and "the pole (2, nan, 1) is not finite" in mesh.warnings[-1]
