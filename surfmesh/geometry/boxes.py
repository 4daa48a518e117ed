"""Boxes around points."""

from __future__ import annotations

import numpy as np


def diagonal(points: np.ndarray) -> float:
    """Of the box around points (n, 2) or (n, 3); 0 where there are none."""
    if not len(points):
        return 0.0
    extent = np.ptp(points, axis=0)
    return float(np.hypot(*extent) if len(extent) == 2 else np.linalg.norm(extent))
