"""The largest of many values, against sorting."""

import numpy as np
import pytest

from surfmesh._core.quality import largest_values as largest
from surfmesh._core.quality import least_values, quantile


@pytest.mark.parametrize("size, count", [(0, 0), (5, 5), (40, 7), (9_000, 400), (9_000, 8_000)])
@pytest.mark.parametrize("kind", ["apart", "ties", "zeros", "nan", "falling"])
def test_they_are_those_of_a_sort(size, count, kind):
    draw = np.random.default_rng(size)
    values = draw.normal(size=size) ** 2
    if kind == "ties":
        values = np.round(values, 1)
    elif kind == "zeros":
        values[values < 2.0] = 0.0
    elif kind == "nan":
        values[draw.random(size) < 0.01] = np.nan
    elif kind == "falling":
        values = np.sort(values)[::-1].copy()
    found = largest(values, count)
    as_sorted = np.where(np.isnan(values), np.inf, values)
    by_value = np.lexsort((np.arange(size), -as_sorted))  # of equal ones the first
    assert found.tolist() == sorted(by_value[:count].tolist())
    rising = np.lexsort((np.arange(size), values))[: np.count_nonzero(~np.isnan(values))]
    assert least_values(values, count).tolist() == rising[:count].tolist()


@pytest.mark.parametrize("size", [1, 2, 3, 100, 1001])
@pytest.mark.parametrize("fraction", [0.0, 0.01, 0.37, 0.99, 1.0])
def test_quantiles_are_those_of_numpy(size, fraction):
    values = np.random.default_rng(size).normal(size=size)
    assert quantile(values, fraction) == float(np.quantile(values, fraction))
    values[size // 2] = np.nan
    assert np.isnan(quantile(values, fraction))
