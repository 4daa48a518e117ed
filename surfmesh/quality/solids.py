"""The solids of a CAD model's mesh, one by one: a face between two of them counts for both."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.topology import vertex_components
from surfmesh.surface_mesh import SurfaceMesh


def solid_mesh(mesh: SurfaceMesh, solid: int) -> SurfaceMesh:
    """The triangles around one solid, facing outwards; on its own vertices, without (u, v)."""
    behind, before = (mesh.solid_ids == solid).T
    rows = np.concatenate([np.flatnonzero(behind), np.flatnonzero(before)])
    plain = SurfaceMesh(
        points=mesh.points, triangles=mesh.triangles, face_ids=mesh.face_ids, sizes=mesh.sizes,
        sizing=mesh.sizing, groups=mesh.groups,
    ).submesh(rows)  # fmt: skip
    triangles = plain.triangles.copy()
    triangles[behind.sum() :] = triangles[behind.sum() :, ::-1]
    return replace(plain, triangles=triangles)


def shares_faces(mesh: SurfaceMesh) -> bool:
    """Do two solids of the model have a face in common?"""
    return mesh.solid_ids is not None and bool((mesh.solid_ids >= 0).all(axis=1).any())


def apart(mesh: SurfaceMesh, pairs: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(k,) which pairs of triangles belong to two bodies of a CAD model, which may touch.

    They bound no solid in common, but one each, or hang together by no vertex.
    """
    if mesh.solid_ids is None or not len(pairs):
        return np.zeros(len(pairs), bool)
    first, second = mesh.solid_ids[pairs[:, 0]], mesh.solid_ids[pairs[:, 1]]
    common = (first[:, :, None] == second[:, None, :]) & (first[:, :, None] >= 0)
    each = (first >= 0).any(axis=1) & (second >= 0).any(axis=1)
    pieces = vertex_components(mesh)[mesh.triangles[pairs][:, :, 0]]
    return ~common.any(axis=(1, 2)) & (each | (pieces[:, 0] != pieces[:, 1]))
