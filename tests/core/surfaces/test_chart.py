"""Axes that are bent where the speed has no bound, against SciPy."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from surfmesh._core.surfaces import Chart, ChartAxis
from surfmesh.geometry.differential.infinite_speed import BentAxis

PLACES = np.array([-1.0, -0.3, 0.6, 1.0])
POWERS = np.array([[1.0, 2.0], [3.0, 1.5], [4.0, 1.0]])


def test_bent_axes_are_those_of_scipy():
    bent = BentAxis(PLACES, POWERS)
    axis = ChartAxis(2.0, np.array([-1.0, 1.0]), np.ones(2), bent.pieces())
    near = 10.0 ** -np.arange(1.0, 12.0)
    x = np.concatenate([np.linspace(-0.1, 2.1, 331), 0.7 + near, 0.7 - near, PLACES + 1.0])
    parameter, rate = axis.parameter_and_rate(x)
    np.testing.assert_allclose(parameter, bent.parameter(x - 1.0), rtol=0, atol=1e-14)
    np.testing.assert_allclose(rate, bent.rates(x - 1.0)[0], rtol=1e-14)


@pytest.mark.parametrize(
    "arguments",
    [
        (0.0, np.zeros(2), np.ones(2)),
        (np.nan, np.zeros(2), np.ones(2)),
        (1.0, np.zeros(1), np.ones(1)),
        (1.0, np.zeros(3), np.ones(2)),
    ],
)
def test_what_is_no_axis_is_refused(arguments):
    with pytest.raises(ValueError):
        ChartAxis(*arguments)


def test_coordinates_are_the_inverse_of_parameters():
    x = np.linspace(0.0, 2.0, 9)
    knots, slopes = x + 0.1 * x * x, 1.0 + 0.2 * x
    chart = Chart(
        ChartAxis(2.0, knots, slopes), ChartAxis(4.0, np.array([1.0, 3.0]), np.full(2, 0.5))
    )
    uv = np.column_stack([np.linspace(knots[0], knots[-1], 41), np.linspace(1.0, 3.0, 41)])
    xy = chart.to_plane(uv)
    assert xy[0].tolist() == [0.0, 0.0] and xy[-1].tolist() == [2.0, 4.0]
    np.testing.assert_allclose(chart.to_uv_and_rates(xy)[0], uv, rtol=0, atol=1e-14)
    assert chart.to_plane(np.array([[-1.0, 9.0]])).tolist() == [[0.0, 4.0]]


@pytest.mark.parametrize("seed", range(5))
def test_knots_are_joined_by_a_cubic_hermite_spline(seed):
    rng = np.random.default_rng(seed)
    n, extent = int(rng.integers(3, 30)), 10.0 ** rng.uniform(-3, 3)
    knots, slopes = np.cumsum(rng.uniform(0, 1, n)), rng.uniform(0, 3, n)
    spline = CubicHermiteSpline(np.linspace(0, extent, n), knots, slopes)
    x = extent * rng.uniform(0, 1, 200)
    parameter, rate = ChartAxis(extent, knots, slopes).parameter_and_rate(x)
    np.testing.assert_allclose(parameter, spline(x), rtol=1e-9, atol=1e-9)
    expected = spline.derivative()(x)
    np.testing.assert_allclose(rate, expected, rtol=1e-6, atol=1e-9 * np.abs(expected).max())


def test_points_along_a_line_are_where_each_is_by_itself():
    """The coordinate that points share is found once."""
    x = np.linspace(0.0, 2.0, 9)
    axis = ChartAxis(2.0, x + 0.1 * x * x, 1.0 + 0.2 * x)
    chart, t = Chart(axis, axis), np.linspace(0.0, 2.4, 50)
    for uv in (np.stack([t, np.full(50, 0.7)], 1), np.stack([np.full(50, 0.7), t], 1)):
        alone = np.concatenate([chart.to_plane(place[None]) for place in uv])
        assert chart.to_plane(uv).tobytes() == alone.tobytes()
