"""Where a curve of the plane leaves circles around a place.

radius  8   .---x      From its start on, the first point that lies on a circle or outside
        4  x--.        it: of evenly spaced fractions the first that does, then of as many
        2 x            between that and the one before, for all circles at once.
 start   o
"""

from __future__ import annotations

import numpy as np

from surfmesh.geometry.planar.curve_contacts import PlaneCurve

EVENLY = np.linspace(0.0, 1.0, 33)
MOST_CLOSER = 8
"""How often one looks more closely, at most: 32 times each."""


def leaving(
    curve: PlaneCurve, start: float, end: float, centre: np.ndarray, radii: np.ndarray,
    enough: float,
) -> np.ndarray:  # fmt: skip
    """Where a curve, from one fraction to another, is first so far (r,) from a centre (2,).

    enough: how near such points are found. Returns (r, 2), nan where it is nowhere so far.
    """
    found = np.full((len(radii), 2), np.nan)
    left = np.arange(len(radii))
    low, high = np.full(len(radii), start), np.full(len(radii), end)
    for _ in range(MOST_CLOSER):
        t = low[:, None] + EVENLY * (high - low)[:, None]
        t[:, -1] = high
        points = curve.evaluate(t.ravel()).reshape(*t.shape, 2)
        far = np.linalg.norm(points - centre, axis=2) >= radii[left, None]
        last = far.argmax(axis=1)
        first, row = np.maximum(last - 1, 0), np.arange(len(left))
        at, reached = points[row, last], far.any(axis=1)
        found[left[reached]] = at[reached]
        step = np.linalg.norm(at - points[row, first], axis=1)
        inexact = reached & (step > enough)
        left, low, high = left[inexact], t[row, first][inexact], t[row, last][inexact]
        if not len(left):
            break
    return found
