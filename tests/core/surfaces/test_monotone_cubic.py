"""The monotone cubic against SciPy's, bit by bit, and what it is for."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from surfmesh._core.surfaces import monotone_cubic


@pytest.mark.parametrize("seed", range(40))
def test_it_is_scipys_to_the_last_bit(seed):
    rng = np.random.default_rng(seed)
    x = np.unique(rng.normal(size=rng.integers(2, 60)))
    y = rng.normal(size=len(x)) if seed % 2 else np.cumsum(rng.exponential(size=len(x)))
    y = np.round(y) if seed % 5 == 0 else y  # level steps
    at = np.concatenate([x, np.linspace(x[0] - 1.0, x[-1] + 1.0, 101)])
    values, derivatives = monotone_cubic(x, y, at)
    theirs = PchipInterpolator(x, y)
    assert np.array_equal(values, theirs(at))
    assert np.array_equal(derivatives, theirs.derivative()(at))


def test_it_rises_where_its_points_do():
    x, y = np.arange(6.0), np.array([0.0, 0.001, 0.002, 5.0, 5.001, 9.0])
    at = np.linspace(0.0, 5.0, 1001)
    values, derivatives = monotone_cubic(x, y, at)
    assert (np.diff(values) >= 0.0).all()
    assert (derivatives >= 0.0).all()
