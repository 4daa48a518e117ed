"""The largest of many values, without sorting or parting all of them; quantiles."""

import numpy as np
from numpy.typing import NDArray

STEP = 16  # one value in so many is looked at first
MORE = 2  # times as many as are wanted lie above the bound that these give, about


def largest(values: NDArray[np.float64], count: int) -> NDArray[np.intp]:
    """Numbers of the ``count`` largest of values (n,), rising; of equal ones those that come
    first. NaN is as large as infinity."""
    if not 0 < count < len(values):
        return np.arange(min(max(count, 0), len(values)))
    if np.isnan(values).any():
        values = np.where(np.isnan(values), np.inf, values)
    some = np.flatnonzero(values >= _bound(values[::STEP], MORE * count // STEP + 1))
    if len(some) < count:
        some = np.arange(len(values))
    least = _bound(values[some], count)
    above = some[values[some] > least]
    equal = some[values[some] == least]
    return np.sort(np.concatenate([above, equal[: count - len(above)]]))


def quantile(values: NDArray[np.float64], fraction: float) -> float:
    """As ``np.quantile`` has it, of values (n,), n > 0, without what that does for any other case:
    linear between two of them in their order, NaN where one is."""
    place = fraction * (len(values) - 1)
    before = int(place)
    after = min(before + 1, len(values) - 1)
    parted = np.partition(values, (before, after, len(values) - 1))
    if np.isnan(parted[-1]):
        return float("nan")
    low, high, part = float(parted[before]), float(parted[after]), place - before
    return low + (high - low) * part if part < 0.5 else high - (high - low) * (1.0 - part)


def _bound(values: NDArray[np.float64], count: int) -> float:
    """The smallest of the ``count`` largest, or of all where there are no more."""
    first = max(len(values) - count, 0)
    return float(np.partition(values, first)[first])
