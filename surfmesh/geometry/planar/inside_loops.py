"""Which points lie within loops."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely


def is_inside(loops: Sequence[np.ndarray], points: np.ndarray) -> np.ndarray:
    """(n,) bool for points (n, 2): within an odd number of the loops (k, 2), not closed."""
    inside = np.zeros(len(points), bool)
    for loop in loops:
        if len(loop) < 3:
            continue
        outline = shapely.make_valid(shapely.Polygon(loop))
        shapely.prepare(outline)
        inside ^= shapely.contains_xy(outline, points[:, 0], points[:, 1])
    return inside
