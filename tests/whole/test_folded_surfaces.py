"""Surfaces that turn over: the mesh follows as far as sizes go, and the report says where."""

import cadquery as cq
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BezierSurface
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array2OfPnt

import surfmesh as sm


def drawn_cubic(corners: list[tuple[float, float]], height: float) -> cq.Shape:
    """A Bezier curve with these control points, drawn along z."""
    poles = TColgp_Array2OfPnt(1, len(corners), 1, 2)
    for k, (x, y) in enumerate(corners, 1):
        poles.SetValue(k, 1, gp_Pnt(x, y, 0.0))
        poles.SetValue(k, 2, gp_Pnt(x, y, height))
    return cq.Shape.cast(BRepBuilderAPI_MakeFace(Geom_BezierSurface(poles), 1e-7).Face())


CUSP = [(1.0, -1.0), (-1.0 / 3.0, 1.0), (-1.0 / 3.0, -1.0), (1.0, 1.0)]  # (t^2, t^3), |t| < 1
LOOP = [(1.0, -1.0), (-1.2, 1.6), (-1.2, -1.6), (1.0, 1.0)]  # crosses itself, smoothly


@pytest.mark.parametrize("anisotropy", [1.0, 20.0])
def test_a_cusp_is_said_of_the_surface_and_not_refined_in_vain(anisotropy):
    model = sm.from_cadquery(drawn_cubic(CUSP, 1.0))
    mesh = sm.mesh(model, sm.Sizing(chord=0.01, anisotropy=anisotropy))
    report = sm.check(mesh)
    assert report.folded == report.inverted == 0 and report.folded_by_surface > 0
    (said,) = [text for text in report.warnings if "folded in themselves" in text]
    assert said in str(report)
    assert all(row.by_surface and row.point[0] < 0.1 for row in report.folded_at)
    assert not any("rounds" in text for text in report.warnings)
    assert report.deviation_max < 0.0101


def test_a_loop_crosses_itself_without_a_fold():
    report = sm.check(sm.mesh(sm.from_cadquery(drawn_cubic(LOOP, 1.0)), sm.Sizing(chord=0.01)))
    assert report.folded == report.folded_by_surface == 0
    assert report.self_intersections > 0
