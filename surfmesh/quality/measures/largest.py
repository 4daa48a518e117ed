"""The largest of many values, without sorting or parting all of them."""

import numpy as np
from numpy.typing import NDArray

STEP = 16  # one value in so many is looked at first
MORE = 2  # times as many as are wanted lie above the bound that these give, about


def largest(values: NDArray[np.float64], count: int) -> NDArray[np.intp]:
    """Numbers of the ``count`` largest of values (n,), in no order; NaN is larger than all."""
    few = values[::STEP]
    above = MORE * count // STEP + 1
    if 0 < above < len(few) and not np.isnan(values).any():
        some = np.flatnonzero(values >= np.partition(few, len(few) - above)[len(few) - above])
        if count <= len(some) < len(values) // 2:
            return some[_parted(values[some], count)]
    return _parted(values, count)


def _parted(values: NDArray[np.float64], count: int) -> NDArray[np.intp]:
    first = len(values) - count
    return (
        np.argpartition(values, first)[first:]
        if 0 < count < len(values)
        else np.arange(max(first, 0), len(values))
    )
