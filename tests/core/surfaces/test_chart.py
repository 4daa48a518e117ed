"""Axes that are bent where the speed has no bound, against SciPy."""

import numpy as np
import pytest

from surfmesh._core.surfaces import ChartAxis
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
