"""Curves of CAD edges: against analysis, against differences, and at their cusps."""

import dataclasses
import pickle

import numpy as np
import pytest

from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.curves import (
    Circle,
    Curve,
    Ellipse,
    Hyperbola,
    Line,
    Parabola,
    points_on,
)
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, bezier_knots
from surfmesh.geometry.cad_surfaces.offset import OffsetCurve

SPACE = {"origin": (1.0, 2.0, 3.0), "x": (0.6, 0.8, 0.0), "y": (0.0, 0.0, 1.0)}
PLANE = {"origin": (1.0, 2.0), "x": (0.6, 0.8), "y": (0.8, -0.6)}  # clockwise


def spline(dimension, rational=True):
    rng = np.random.default_rng(dimension)
    knots = [0, 0, 0, 0, 0, 0.4, 0.7, 1.5, 1.5, 1.5, 1.5, 1.5]
    weights = rng.uniform(0.5, 2.0, 7) if rational else None
    return BSplineCurve(knots, rng.normal(size=(7, dimension)), weights)


def closed(dimension):
    """Degree 2 round six points, unrolled: two functions reach over the seam."""
    rng = np.random.default_rng(dimension)
    control = rng.normal(size=(6, dimension))
    return BSplineCurve(np.arange(-2.0, 9.0), control[np.arange(8) % 6], period=6.0)


def curves(frame):
    dimension = len(frame["origin"])
    direction = None if dimension == 2 else (0.0, 0.6, 0.8)
    ellipse = Ellipse(**frame, major=2.0, minor=1.0)
    return [
        Line(frame["origin"], frame["x"]),
        Circle(**frame, radius=2.0),
        ellipse,
        Hyperbola(**frame, major=2.0, minor=1.0),
        Parabola(**frame, focal=0.7),
        spline(dimension),
        spline(dimension, rational=False),
        closed(dimension),
        OffsetCurve(ellipse, 0.3, direction),
        OffsetCurve(closed(dimension), -0.2, direction, (1.0, 2.0)),
    ]


CURVES = curves(SPACE) + curves(PLANE)
NAMES = [f"{number} {curve.kind} {curve.dimension}D" for number, curve in enumerate(CURVES)]


@pytest.mark.parametrize("curve", CURVES, ids=NAMES)
def test_derivatives_are_limits_of_differences(curve):
    assert isinstance(curve, Curve)
    step, t = 1e-5, np.array([0.1, 0.35, 0.62, 0.9, 1.2])
    values = curve.evaluate(t, 3)
    ahead, behind = curve.evaluate(t + step, 2), curve.evaluate(t - step, 2)
    for k in range(3):
        found = (ahead[k] - behind[k]) / (2 * step)
        assert np.abs(found - values[k + 1]).max() < 1e-7 * (1 + np.abs(values[k + 1]).max())
    for order in range(3):
        lower = curve.evaluate(t, order)
        assert len(lower) == order + 1
        for a, b in zip(lower, values):
            assert a.shape == (5, curve.dimension)
            assert a == pytest.approx(b, abs=1e-13)
    assert curve.evaluate(t[:0], 1)[1].shape == (0, curve.dimension)


@pytest.mark.parametrize("curve", CURVES, ids=NAMES)
def test_curves_travel_and_do_not_change(curve):
    t = np.linspace(0.1, 1.3, 7)
    copy = pickle.loads(pickle.dumps(curve))
    assert np.array_equal(copy.evaluate(t, 2), curve.evaluate(t, 2))
    part = curve.with_limits(0.2, 0.3)
    assert np.array_equal(part.evaluate(t, 2), curve.evaluate(t, 2))
    with pytest.raises(dataclasses.FrozenInstanceError):
        curve.kind = "other"
    if curve.period:
        here, there = curve.evaluate(t, 2), curve.evaluate(t + 2 * curve.period, 2)
        assert np.array(there) == pytest.approx(np.array(here), rel=1e-11, abs=1e-12)


def test_conics():
    t = np.linspace(-1.0, 1.0, 9)
    (c,) = Hyperbola((0, 0), (1, 0), (0, 1), 2.0, 1.0).evaluate(t)
    assert c[:, 0] ** 2 / 4 - c[:, 1] ** 2 == pytest.approx(1.0)
    (c,) = Parabola((0, 0), (1, 0), (0, 1), 0.7).evaluate(t)
    assert np.hypot(c[:, 0] - 0.7, c[:, 1]) == pytest.approx(c[:, 0] + 0.7)  # focus, directrix


def test_an_offset_lies_to_the_right_of_a_plane_curve():
    counterclockwise = Circle((0, 0), (1, 0), (0, 1), 2.0)
    t = np.linspace(0, 6, 9)
    for distance in (0.5, -0.5):
        larger = Circle((0, 0), (1, 0), (0, 1), 2.0 + distance)
        offset = OffsetCurve(counterclockwise, distance)
        assert np.array(offset.evaluate(t, 3)) == pytest.approx(np.array(larger.evaluate(t, 3)))
    offset_in_space = OffsetCurve(Circle((0, 0, 1), (1, 0, 0), (0, 1, 0), 2.0), 0.5, (0, 0, 1))
    larger = Circle((0, 0, 1), (1, 0, 0), (0, 1, 0), 2.5)
    assert np.array(offset_in_space.evaluate(t, 3)) == pytest.approx(
        np.array(larger.evaluate(t, 3))
    )


def test_an_offset_at_a_cusp_is_that_close_by():
    # (t^2, t^3): no tangent at 0, where its direction tends to +x from inside [0, 1]
    cusp = BSplineCurve(bezier_knots(3), [[0, 0], [0, 0], [1 / 3, 0], [1, 1]])
    for limits in (None, (0.0, 1.0)):
        c, *derivatives = OffsetCurve(cusp, 0.5, limits=limits).evaluate([0.0, 0.5], 2)
        assert c[0] == pytest.approx([0.0, -0.5], abs=1e-7)
        assert np.isfinite(derivatives).all()


def test_a_part_that_ends_at_a_kink():
    kinked = BSplineCurve([-1, -1, 0, 1, 1.0], [[-1, 1], [0, 0], [1, 1.0]])
    assert kinked.evaluate([0.0], 1)[1][0, 1] == 1.0
    assert kinked.with_limits(-1, 0).evaluate([0.0], 1)[1][0, 1] == -1.0
    offset = OffsetCurve(kinked, np.sqrt(2.0)).with_limits(-1, 0)
    assert offset.evaluate([0.0])[0][0] == pytest.approx([-1.0, -1.0])


def test_what_makes_no_curve_is_refused():
    with pytest.raises(SurfaceError, match="5 knots and 5 control points"):
        BSplineCurve(np.arange(5.0), np.zeros((5, 2)))
    with pytest.raises(SurfaceError, match="no interval"):
        BSplineCurve([0, 1, 1, 2.0], [[0, 0], [1, 1.0]])
    with pytest.raises(SurfaceError, match="none in the plane"):
        OffsetCurve(CURVES[-1], 0.3, (0, 0, 1))


@pytest.mark.parametrize("frame", [PLANE, SPACE])
def test_many_curves_at_once_give_what_each_gives_alone(frame):
    every = curves(frame)
    t = np.linspace(0.1, 1.2, 5) + np.arange(len(every))[:, None] / 100
    found = points_on(every, t)
    assert found.shape == (len(every), 5, len(frame["origin"]))
    for own, curve, row in zip(found, every, t):
        assert np.array_equal(own, curve.evaluate(row, 0)[0])


def test_curves_of_both_dimensions_have_no_common_array():
    with pytest.raises(ValueError, match="dimension"):
        points_on([Circle(**PLANE, radius=1.0), Circle(**SPACE, radius=1.0)], np.zeros((2, 1)))
    with pytest.raises(ValueError, match="rows"):
        points_on([Circle(**PLANE, radius=1.0)], np.zeros((2, 1)))
