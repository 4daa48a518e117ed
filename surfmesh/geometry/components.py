"""Which things hang together: connected components, each called by its smallest member."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surfmesh._core.space import component_labels


def components(count: int, pairs: ArrayLike) -> NDArray[np.int32]:
    """(count,) the smallest of those that each thing hangs together with; pairs: (k, 2) things."""
    return component_labels(count, np.ascontiguousarray(pairs, np.int32).reshape(-1, 2))
