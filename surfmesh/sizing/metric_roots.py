"""Metric roots: symmetric matrices M^(1/2) that turn a step into its length in wanted edges.

In space W is packed as (n, 6): xx, xy, xz, yy, yz, zz; in the plane (n, 3): xx, xy, yy.
"""

import numpy as np

_ROW, _COLUMN = [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]
_PLACE = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
DIAGONAL = [0, 3, 5]
"""Where xx, yy, zz stand in a packed root."""


def unpacked(roots: np.ndarray) -> np.ndarray:
    """(..., 6) -> (..., 3, 3)."""
    return roots[..., _PLACE]


def outer(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """a b^T of parallel vectors (n, 3), packed (n, 6)."""
    return first[:, _ROW] * second[:, _COLUMN]


def uniform(inverse_sizes: np.ndarray) -> np.ndarray:
    """Id / h for 1 / h (n,), packed (n, 6)."""
    roots = np.zeros((len(inverse_sizes), 6))
    roots[:, DIAGONAL] = inverse_sizes[:, None]
    return roots
