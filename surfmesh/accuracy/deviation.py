"""The distance of points, and of triangles, from the true surface: measured in the core.

The mesher measures with the same functions, and so the report finds what it aimed at.
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import surfaces
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface

STEPS = 12
"""Of the projection, at most: where the speed along u changes fast, a guess is poor."""


def nearest_deviations(
    surface: Surface,
    points: NDArray[np.float64],
    uv: NDArray[np.float64],
    corners: NDArray[np.float64],
    triangle: NDArray[np.integer],
    limit: float,
    steps: int,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Parameters (n, 2) of the nearest points of the surface, and the distances (n,).

    uv: (n, 2) first guesses. corners: (m, 3, 2) of triangles and ``triangle`` (n,) that of each
    point: the search begins anew from them where a point seems farther away than ``limit``.
    """
    return surfaces.closest_points_in_triangles(
        as_core_surface(surface), points, uv, corners, np.asarray(triangle, np.int64), limit, steps
    )
