"""The distance of points, and of triangles, from the true surface: measured in the core.

The mesher measures with the same functions, and so the report finds what it aimed at.
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import patch, surfaces
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface

STEPS = 12
"""Of the projection, at most: where the speed along u changes fast, a guess is poor."""


def point_deviations(
    surface: Surface,
    points: NDArray[np.float64],
    uv: NDArray[np.float64],
    size: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances (n,) of points (n, 3) from the surface, and its normals (n, 3) near them.

    uv: (n, 2) parameters of a surface point nearby; size: (n,) of the triangle. Read in the
    tangent plane where the foot is near, else in the one a Newton step further, else by
    projection.
    """
    return patch.point_deviations(as_core_surface(surface), points, uv, size)


def vertex_deviations(
    surface: Surface,
    points: NDArray[np.float64],
    uv: NDArray[np.float64],
    size: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The same (n,) of points that should be r(u, v) itself: looked at closely only if not."""
    return patch.vertex_deviations(as_core_surface(surface), points, uv, size)


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
