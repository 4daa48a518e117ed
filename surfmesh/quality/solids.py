"""The solids of a CAD model's mesh, one by one: a face between two of them counts for both."""

from dataclasses import replace

import numpy as np

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
