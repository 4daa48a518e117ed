"""Ranges of places, one a row, written out as pairs."""

import numpy as np
from numpy.typing import NDArray


def expanded(first: NDArray, last: NDArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(row, place) for every place from first[row] up to last[row]."""
    count = np.maximum(last - first, 0)
    row = np.repeat(np.arange(len(first)), count)
    ahead = np.cumsum(count) - count
    return row, np.arange(len(row)) - ahead[row] + first[row]
