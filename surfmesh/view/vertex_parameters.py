"""One surface and one (u, v) for every vertex, where it has several."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.result.surface_mesh import SurfaceMesh


class VertexParameters(NamedTuple):
    """Those of the last triangle at each vertex."""

    face: NDArray[np.int32]  # (n,)
    uv: NDArray[np.float64]  # (n, 2)


def vertex_parameters(mesh: SurfaceMesh) -> VertexParameters | None:
    """Where the vertices lie on the surfaces of ``mesh``, or None when it carries none."""
    corners = mesh.parametrisation
    if not mesh.surfaces or corners is None:
        return None
    corner = np.zeros(len(mesh.points), np.int64)
    corner[mesh.triangles.reshape(-1)] = np.arange(mesh.triangles.size)
    uv = corners.uv_points[corners.uv_triangles.reshape(-1)[corner]]
    return VertexParameters(mesh.face_ids[corner // 3], uv)
