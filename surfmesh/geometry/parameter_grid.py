"""A grid of parameters all over the domain of a surface."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def parameter_grid(domain: Sequence[Sequence[float]], count: int) -> NDArray[np.float64]:
    """(count^2, 2) parameters, the sides among them; u runs fastest."""
    lines = [np.linspace(first, last, count) for first, last in domain]
    return np.stack(np.meshgrid(*lines), axis=-1).reshape(-1, 2)
