"""Splines through points as scipy's, made by the core: LAPACK's banded solver gives other bits on
other processors (``src/surfaces/spline_through_points.hpp``)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.surfaces import spline_through_points

if TYPE_CHECKING:
    from scipy.interpolate import BSpline


def interpolating_spline(
    places: NDArray[np.float64], values: NDArray[np.float64], degree: int
) -> BSpline:
    """The spline of odd degree k through values (n, d) at places (n,) that rise, n > k, with the
    knots of ``scipy.interpolate.make_interp_spline``: "not a knot" beside its ends."""
    from scipy.interpolate import BSpline  # heavy, and few need it

    return BSpline(*spline_through_points(places, values, degree), degree)
