"""How far along a polygon in space its nodes lie."""

import numpy as np


def lengths_along(points: np.ndarray) -> np.ndarray:
    """Lengths (n,) from the first of points (n, 3) to each of them."""
    return np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]


def fractions_along(points: np.ndarray) -> np.ndarray:
    """The same of the whole length, 0 to 1; evenly spread where there is none."""
    length = lengths_along(points)
    return length / length[-1] if length[-1] > 0.0 else np.linspace(0.0, 1.0, len(points))
