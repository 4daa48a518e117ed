"""Singular formulas end: with a mesh that is said not to be clean, or a reason with the place."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import MeshingError, SizingError
from surfmesh.geometry.differential.chart import Chart
from surfmesh.meshing import parametric_mesh
from surfmesh.sizing.field import field_builder

TURN = (0, "2*pi")


@pytest.fixture(autouse=True)
def small_budgets(monkeypatch):
    """The same rules with fewer cells, for quick tests."""
    monkeypatch.setattr(field_builder, "FREE_CELLS", 20_000)
    monkeypatch.setattr(parametric_mesh, "MOST_CELLS", 25_000)


def test_a_line_of_infinite_speed_within_the_domain_is_refused_with_its_place():
    circle = sm.ParametricSurface("u", "v", "sqrt(abs(1-u**2-v**2))", u=(-1, 1), v=(-1, 1))
    with pytest.raises(SizingError, match=r"near \(u, v\) = \(.*\), where the surface may be sing"):
        sm.mesh(circle)


def test_an_inner_circle_that_is_a_point_is_refused_with_its_place():
    horn_torus = sm.ParametricSurface(
        "(1+cos(v))*cos(u)", "(1+cos(v))*sin(u)", "sin(v)", u=TURN, v=TURN
    )
    with pytest.raises((MeshingError, SizingError), match="near"):
        sm.mesh(horn_torus, sm.Sizing(chord=5e-3))


def test_scherk_near_its_poles_ends_and_says_what_is_left(monkeypatch):
    monkeypatch.setattr(field_builder, "FREE_CELLS", 100_000)
    side = 1.5707
    scherk = sm.ParametricSurface("u", "v", "log(cos(v)/cos(u))", u=(-side, side), v=(-side, side))
    report = sm.check(sm.mesh(scherk))
    assert not report.clean and report.problems


def test_speeds_of_many_orders_give_an_axis_that_follows_the_length():
    """tan(u) up to 1.57 has nearly all its length in the last of 257 even steps."""
    wall = sm.ParametricSurface("u", "v", "tan(u)", u=(-1.57, 1.57), v=(0, 1))
    chart = Chart.of(wall)
    assert chart.extent[0] == pytest.approx(2 * np.tan(1.57), rel=0.01)
    assert sm.check(sm.mesh(wall)).clean
