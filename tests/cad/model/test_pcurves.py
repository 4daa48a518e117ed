"""A p-curve that runs at the wrong pace, or beside its edge, gives way to a better one."""

from dataclasses import replace

import numpy as np
import pytest

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge
from surfmesh.cad.model.pcurves import follows
from surfmesh.geometry.cad_surfaces.curves import Circle
from surfmesh.geometry.cad_surfaces.elementary import Cylinder
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve

X, Y, Z = np.eye(3)
EDGE = CadEdge(Circle(np.zeros(3), X, Y, 2.0), 0.0, 3.0, 0, 1, 1e-7, False, "", 6.0)
CYLINDER = Cylinder(np.zeros(3), X, Y, Z, radius=2.0, domain=((0.0, 3.0), (-1.0, 1.0)))
FRACTION = np.linspace(0.0, 1.0, 301)


def coedge(control):
    """A cubic p-curve with p from 0 to 1."""
    knots = np.repeat([0.0, 1.0], 4)
    return CadCoedge(0, False, BSplineCurve(knots, np.array(control)), 0.0, 1.0, False)


def deviation(edge, pcurve):
    points = edge.curve.evaluate(edge.parameters(FRACTION), 0)[0]
    (on_face,) = CYLINDER.evaluate(pcurve.uv(FRACTION), 0)
    return np.linalg.norm(on_face - points, axis=1).max()


@pytest.mark.parametrize("middle", [0.0, 0.02])  # at another pace; and beside the edge as well
def test_a_straying_pcurve_is_replaced(middle):
    strayed = coedge([[0, 0], [0.8, middle], [2.1, middle], [3, 0]])
    assert deviation(EDGE, strayed) > 0.05
    better = follows(CYLINDER, EDGE, strayed, 1e-7)
    assert deviation(EDGE, better) < 1e-7
    ends = np.array([0.0, 1.0])
    assert better.uv(ends) == pytest.approx(strayed.uv(ends), abs=1e-14)


def test_a_pcurve_that_is_a_loop_by_itself_may_start_elsewhere():
    turn = 2.0 * np.pi
    round_edge = replace(EDGE, t1=turn, end=0, length=2.0 * turn)
    wide = replace(CYLINDER, domain=((-1.0, 8.0), (-1.0, 1.0)))
    away = coedge([[0.5 + turn * t, 0.0] for t in (0.0, 1 / 3, 2 / 3, 1.0)])
    better = follows(wide, round_edge, away, 1e-7, is_loop=True)
    assert deviation(round_edge, better) < 1e-7
    start, end = better.uv(np.array([0.0, 1.0]))
    assert end - start == pytest.approx([turn, 0.0], abs=1e-14)


def test_a_pcurve_that_cannot_be_better_stays():
    """The circle lies inside the cylinder: no point of that is nearer than the p-curve."""
    inside = CadEdge(Circle(np.zeros(3), X, Y, 1.9), 0.0, 3.0, 0, 1, 1e-7, False, "", 5.7)
    exact = coedge([[0, 0], [1, 0], [2, 0], [3, 0]])
    assert follows(CYLINDER, inside, exact, 1e-7) is exact
    assert deviation(inside, exact) == pytest.approx(0.1)
