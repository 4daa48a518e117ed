"""Closed polygons (k, 2) of the plane, whose first corner is not repeated."""

import numpy as np

from surfmesh.geometry.small_matrices import product


def next_ones(values: np.ndarray) -> np.ndarray:
    """The one after each of n, after the last the first, as ``np.roll`` has it; much faster."""
    return np.concatenate([values[1:], values[:1]])


def ring_area(ring: np.ndarray) -> float:
    """Area that a polygon (k, 2) runs round, positive counter-clockwise."""
    u, v = (ring - ring.sum(axis=0) / len(ring)).T
    return 0.5 * float(product(u, next_ones(v)) - product(v, next_ones(u)))
