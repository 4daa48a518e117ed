"""Corners of triangles, each by itself, to shared vertices: equal coordinates are one point."""

import numpy as np
from numpy.typing import NDArray


def welded(corners: NDArray) -> tuple[NDArray, NDArray[np.int64]]:
    """Distinct points in order of first use, and the triangles (m, 3) of them.

    corners: (3 m, 3).
    """
    order = np.lexsort(corners.T)  # stable: the first of equals is the earliest
    ranked = corners[order]
    new = np.ones(len(ranked), bool)
    new[1:] = (ranked[1:] != ranked[:-1]).any(axis=1)
    label = np.empty(len(corners), np.int64)
    label[order] = np.cumsum(new) - 1
    first = order[new]
    by_use = np.argsort(first)
    rank = np.empty(len(first), np.int64)
    rank[by_use] = np.arange(len(first))
    return corners[first[by_use]], rank[label].reshape(-1, 3)
