"""Lines of a surface that are one point: known ones, and those that have to be found."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh.geometry.cad_surfaces.curves import Circle
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Sphere, Torus
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, BSplineSurface, bezier_knots
from surfmesh.geometry.cad_surfaces.singular_lines import singular_lines
from surfmesh.geometry.cad_surfaces.swept import RevolutionSurface

FRAME = {"origin": (1.0, -2.0, 0.5), "x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
TURN = (0.0, 2.0 * np.pi)


def values(surface):
    return [(line.axis, line.value) for line in singular_lines(surface)]


@settings(max_examples=30, deadline=None)
@given(st.floats(0.05, 1.0), st.floats(1e-3, 1e3), st.floats(-7.0, 7.0))
def test_a_spindle_torus_meets_its_axis_twice_a_turn(ratio, size, start):
    torus = Torus(
        **FRAME, radius=ratio * size, tube=size, domain=(TURN, (start, start + 2.0 * np.pi))
    )
    lines = singular_lines(torus)
    assert 1 <= len(lines) <= 3  # one at a horn; a line at the start is at the end, too
    for line in lines:
        around = np.array([line.at(u) for u in np.linspace(0.0, 6.0, 7)])
        (points,) = torus.evaluate(around, 0)
        assert np.abs(points - line.point).max() < 1e-7 * size


def test_a_torus_with_a_hole_has_none():
    assert not values(Torus(**FRAME, radius=2.0 + 1e-6, tube=2.0, domain=(TURN, TURN)))
    assert not values(Cylinder(**FRAME, radius=1.0, domain=(TURN, (0.0, 1.0))))


def test_a_cone_has_its_apex_and_a_sphere_its_poles_within_their_domains():
    cone = Cone(**FRAME, radius=1.0, angle=np.pi / 6, domain=(TURN, (-4.0, 4.0)))
    assert values(cone) == [(1, pytest.approx(-2.0))]
    assert not values(cone.with_domain((TURN, (-1.0, 4.0))))
    sphere = Sphere(**FRAME, radius=3.0, domain=(TURN, (0.0, np.pi / 2)))
    assert values(sphere) == [(1, pytest.approx(np.pi / 2))]


@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_profile_that_meets_its_axis_inside_is_found(order):
    """x = t^order about t = 0.3, by its Bezier polygon."""
    t = np.linspace(0.0, 1.0, 4)
    basis = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=1)
    control = np.linalg.solve(basis, np.stack([(t - 0.3) ** order, 0.0 * t, t], axis=1))
    curve = BSplineCurve(bezier_knots(3), control, kind="bezier")
    surface = RevolutionSurface(curve, (0, 0, 0), (0, 0, 1), domain=(TURN, (0.0, 1.0)))
    (line,) = singular_lines(surface)
    assert line.axis == 1
    assert line.value == pytest.approx(0.3, abs=1e-2 if order == 3 else 1e-4)
    assert np.abs(line.point - (0.0, 0.0, 0.3)).max() < 1e-2


@pytest.mark.parametrize("axis", [0, 1])
def test_a_row_of_control_points_in_one_point_is_found_inside_and_at_the_rim(axis):
    control = np.zeros((4, 5, 3))
    control[..., 0], control[..., 1] = np.meshgrid(np.arange(4.0), np.arange(5.0), indexing="ij")
    control[:, 2] = (1.5, 2.0, 1.0)
    control[:, 4] = (1.5, 4.0, 0.0)
    knots = np.array([0.0, 0, 0, 1, 1, 2, 2, 2]), bezier_knots(3)
    if axis == 0:
        surface = BSplineSurface(*knots, control.transpose(1, 0, 2), domain=((0, 2), (0, 1)))
    else:
        surface = BSplineSurface(*knots[::-1], control, domain=((0, 1), (0, 2)))
    assert values(surface) == [(axis, pytest.approx(1.0, abs=1e-6)), (axis, 2.0)]


@pytest.mark.parametrize("apart", [1.0, 0.02, 3e-3])
def test_two_points_near_each_other_are_told_apart(apart):
    """A circle turned about its own secant, as files have a spindle torus."""
    circle = Circle((np.cos(apart / 2), 0, 0), (1, 0, 0), (0, 0, 1), radius=1.0)
    surface = RevolutionSurface(circle, (0, 0, 0), (0, 0, 1), domain=(TURN, TURN))
    assert values(surface) == [
        (1, pytest.approx(np.pi - apart / 2)), (1, pytest.approx(np.pi + apart / 2))
    ]  # fmt: skip
