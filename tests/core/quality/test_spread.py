"""Least, mean, largest and standard deviation: the core against numpy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfmesh._core.quality import spread


@given(st.integers(0, 2**31), st.sampled_from([1, 7, 8, 9, 511, 512, 513, 1031, 20_000]))
def test_spread_of_any_number_of_values(seed, count):
    values = np.random.default_rng(seed).lognormal(size=count)
    least, mean, largest, deviation = spread(values)
    assert (least, largest) == (values.min(), values.max())
    assert mean == pytest.approx(values.mean(), rel=1e-15)
    assert deviation == pytest.approx(values.std(), rel=1e-14, abs=1e-15)


def test_what_is_not_a_number_makes_all_of_them_so():
    assert np.isnan(spread(np.empty(0))).all()
    assert np.isnan(spread(np.array([1.0, np.nan, 2.0]))).all()
    least, _, largest, _ = spread(np.array([1.0, -np.inf, np.inf]))
    assert (least, largest) == (-np.inf, np.inf)
