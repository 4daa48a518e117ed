"""How far triangles lie from their surfaces, and on which side: along the normal r_u x r_v."""

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.space import tangent_plane_offsets
from surfmesh.geometry.small_matrices import product
from surfmesh.geometry.surface import Surface
from surfmesh.result.surface_mesh import SurfaceMesh

PLACES = (
    np.array([(3, 3, 0), (0, 3, 3), (3, 0, 3), (2, 2, 2), (4, 1, 1), (1, 4, 1), (1, 1, 4)]) / 6.0
)
"""Barycentric, where triangles are looked at: the middles of the sides, and within."""

STEPS = 2  # by Gauss and Newton from r(u, v) at the interpolated parameters
BLOCK = 1 << 12  # triangles looked at together


def signed_distances(
    mesh: SurfaceMesh,
    points: NDArray[np.float64],
    places: NDArray[np.float64] = PLACES,
    triangles: NDArray[np.int64] | None = None,
) -> NDArray[np.float64]:
    """Distances (m, q) of triangles, of all or of some (m,), on ``points`` (n, 3) at ``places``
    (q, 3), positive on the side of the surface's own normal; 0 where it has none."""
    corners = mesh.parametrisation
    assert corners is not None  # noqa: S101  for mypy: whoever has surfaces has parameters
    some = np.arange(len(mesh.triangles)) if triangles is None else triangles
    found, faces = np.zeros((len(some), len(places))), mesh.face_ids[some]
    for face in np.unique(faces).tolist():
        rows = np.flatnonzero(faces == face)
        for start in range(0, len(rows), BLOCK):
            block = rows[start : start + BLOCK]
            own = some[block]
            uv = product(places, corners.uv_points[corners.uv_triangles[own]])
            at = product(places, points[mesh.triangles[own]])
            found[block] = _along_normals(mesh.surfaces[face], at, uv)
    return found


def _along_normals(
    surface: Surface, points: NDArray[np.float64], uv: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Signed distances of points (k, q, 3) from the surface near parameters (k, q, 2)."""
    shape = points.shape[:2]
    points, uv = points.reshape(-1, 3), uv.reshape(-1, 2)
    low, high = np.array(surface.domain).T
    for step in range(STEPS + 1):
        foot, ru, rv = (np.ascontiguousarray(x) for x in surface.evaluate(uv, 1))
        offset = tangent_plane_offsets(points, foot, ru, rv)
        if step < STEPS:
            uv = np.clip(uv + offset[:, 5:], low, high)
    along: NDArray[np.float64] = np.einsum("ij,ij->i", offset[:, :3], points - foot)
    return along.reshape(shape)
