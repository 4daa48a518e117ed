"""Bent axes against the cubic Hermite spline of scipy."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from surfmesh._core.patch import ChartAxis


def bend(x, extent, knots, slopes):
    return ChartAxis(extent, knots, slopes).parameter_and_rate(x)


@pytest.mark.parametrize("seed", range(5))
def test_cubic_hermite_spline(seed):
    rng = np.random.default_rng(seed)
    n, extent = int(rng.integers(3, 30)), 10.0 ** rng.uniform(-3, 3)
    knots, slopes = np.cumsum(rng.uniform(0, 1, n)), rng.uniform(0, 3, n)
    spline = CubicHermiteSpline(np.linspace(0, extent, n), knots, slopes)
    x = extent * rng.uniform(0, 1, 200)
    parameter, rate = bend(x, extent, knots, slopes)
    np.testing.assert_allclose(parameter, spline(x), rtol=1e-9, atol=1e-9)
    expected = spline.derivative()(x)
    np.testing.assert_allclose(rate, expected, rtol=1e-6, atol=1e-9 * np.abs(expected).max())


def test_linear_outside():
    knots, slopes = np.array([1.0, 2.0, 5.0]), np.array([0.5, 1.0, 4.0])
    parameter, rate = bend(np.array([-2.0, 0.0, 2.0, 5.0]), 2.0, knots, slopes)
    assert tuple(parameter) == pytest.approx((0.0, 1.0, 5.0, 17.0))
    assert tuple(rate) == pytest.approx((0.5, 0.5, 4.0, 4.0))


def test_what_is_not_a_number_stays_so():
    parameter, _ = bend(np.array([np.nan, np.inf]), 1.0, np.array([0.0, 1.0]), np.ones(2))
    assert np.isnan(parameter[0]) and not np.isfinite(parameter[1])


@pytest.mark.parametrize(
    "extent, knots, slopes", [(0.0, 2, 2), (np.nan, 2, 2), (np.inf, 2, 2), (1.0, 1, 1), (1.0, 3, 2)]
)
def test_axes_that_are_none_are_refused(extent, knots, slopes):
    with pytest.raises(ValueError):
        bend(np.zeros(3), extent, np.ones(knots), np.ones(slopes))
