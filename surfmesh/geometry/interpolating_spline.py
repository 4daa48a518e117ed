"""Splines through points, the same bits on every processor: LAPACK's banded solver is not.

Interpolation matrices of B-splines are totally positive, so that elimination needs no pivots:
de Boor and Pinkus, "Backward error analysis for totally positive linear systems", 1977.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.interpolate import BSpline


def interpolating_spline(
    places: NDArray[np.float64], values: NDArray[np.float64], degree: int
) -> BSpline:
    """The spline of odd degree k through values (n, d) at places (n,) that rise, n > k, with the
    knots of ``scipy.interpolate.make_interp_spline``: "not a knot" beside its ends."""
    from scipy.interpolate import BSpline  # heavy, and few need it

    beside = (degree + 1) // 2
    inner = places[beside:-beside]
    ends = np.repeat(places[[0, -1]], degree + 1)
    knots = np.concatenate([ends[: degree + 1], inner, ends[degree + 1 :]])
    rows = BSpline.design_matrix(places, knots, degree)
    count = len(places)
    columns = rows.indices.reshape(count, degree + 1)
    band = np.zeros((count, 2 * degree + 1))  # entry (i, j) at (i, j - i + degree)
    line = np.arange(count)[:, None]
    band[line, columns - line + degree] = rows.data.reshape(count, degree + 1)
    return BSpline(knots, _solved(band, np.array(values, float), degree), degree)


def _solved(band: NDArray[np.float64], right: NDArray[np.float64], width: int) -> NDArray:
    """The solution (n, d) of a system with so many diagonals on either side; both are used up."""
    count = len(band)
    for j in range(count):
        for i in range(j + 1, min(j + width + 1, count)):
            start = j - i + width
            factor = band[i, start] / band[j, width]
            if factor != 0.0:
                band[i, start : start + width + 1] -= factor * band[j, width:]
                right[i] -= factor * right[j]
    for j in range(count - 1, -1, -1):
        after = right[j + 1 : j + 1 + width]
        known = band[j, width + 1 : width + 1 + len(after)]
        right[j] = (right[j] - (known[:, None] * after).sum(axis=0)) / band[j, width]
    return right
