"""Bounds of vectors, as intervals of their components, seen along directions."""

from __future__ import annotations

import numpy as np


def along(a: tuple[np.ndarray, np.ndarray], normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Intervals (n, d) of n.x for x (n, 3) in a = (lower, upper), normals (n, d, 3)."""
    lower, upper = a[0][:, None], a[1][:, None]
    low = np.where(normal > 0.0, normal * lower, normal * upper)
    high = np.where(normal > 0.0, normal * upper, normal * lower)
    none = np.broadcast_to(normal == 0.0, low.shape)  # times infinity is 0 too: x is finite
    low[none] = high[none] = 0.0
    return low.sum(axis=2), high.sum(axis=2)


def largest_along(lower: np.ndarray, upper: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Bound (n, d) of |n.x|, likewise."""
    low, high = along((lower, upper), normal)
    return np.maximum(np.abs(low), np.abs(high))
