"""Shape of the triangles in 3D: alpha, radius ratio, angles, areas; the volume they enclose."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import enclosed_volumes
from surfmesh._core.space import triangle_shapes
from surfmesh.accuracy.shape import mean_ratio
from surfmesh.quality.measures.lengths import stretched
from surfmesh.result.surface_mesh import SurfaceMesh

BLOCK = 1 << 16  # triangles looked at together, to bound the memory


class Shapes(NamedTuple):
    """One value a triangle; angles in degrees, areas in square model units.

    alpha = 4 sqrt(3) area / (|AB|^2 + |BC|^2 + |CA|^2); radius ratio = 2 r_in / r_circum.
    Both are 1 for the equilateral triangle and 0 for a degenerate one.
    """

    area: NDArray[np.float64]
    alpha: NDArray[np.float64]
    radius_ratio: NDArray[np.float64]
    min_angle: NDArray[np.float64]
    max_angle: NDArray[np.float64]


def shapes(mesh: SurfaceMesh) -> Shapes:
    """Shape of every triangle of ``mesh``."""
    return Shapes(*triangle_shapes(mesh.points, mesh.triangles))


def alpha(mesh: SurfaceMesh) -> NDArray[np.float64]:
    """(m,) shape measure alpha of every triangle, in 3D."""
    return shapes(mesh).alpha


def metric_alpha(mesh: SurfaceMesh) -> NDArray[np.float64]:
    """(m,) alpha of every triangle in the mean metric of its corners.

    In 3D where sizes are isotropic: there it is the same.
    """
    parameters = mesh.parametrisation
    if parameters is None or parameters.metric_root_3d is None:
        return alpha(mesh)
    found = np.zeros(len(mesh.triangles))
    for start in range(0, len(found), BLOCK):
        corners = mesh.triangles[start : start + BLOCK]
        a, b, c = (mesh.points[corner] for corner in corners.T)
        rows = parameters.uv_triangles[start : start + BLOCK]
        mean = parameters.metric_root_3d[rows].mean(axis=1)
        u, v = stretched(mean, b - a), stretched(mean, c - a)
        found[start : start + BLOCK] = mean_ratio(u, v)
    return found


def enclosed_volume(mesh: SurfaceMesh) -> float:
    """Volume inside a closed oriented mesh, positive when its triangles face outwards.

    Sum of the signed tetrahedra to one point (divergence theorem).
    """
    apex = mesh.points.mean(axis=0)
    whole = np.zeros(len(mesh.triangles), np.int32)
    return float(enclosed_volumes(mesh.points, mesh.triangles, whole, apex[None])[0])
