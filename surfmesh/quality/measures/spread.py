"""How values are spread: the least, the mean, the largest, and the standard deviation."""

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import spread


class Spread(NamedTuple):
    """Of values: nan where there are none, or one is."""

    least: float
    mean: float
    largest: float
    deviation: float  # standard

    @classmethod
    def of(cls, values: NDArray[np.float64]) -> Self:
        """values: (k,)"""
        return cls(*spread(values))
