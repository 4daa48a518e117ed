"""The solids of a CAD model's mesh, one by one: a face between two of them counts for both."""

from dataclasses import replace

import numpy as np

from surfmesh.surface_mesh import SurfaceMesh


def solid_mesh(mesh: SurfaceMesh, solid: int) -> SurfaceMesh:
    """The triangles around one solid, facing outwards; on its own vertices, without (u, v)."""
    behind, before = (mesh.solid_ids == solid).T
    triangles = np.concatenate([mesh.triangles[behind], mesh.triangles[before][:, ::-1]])
    used, rows = np.unique(triangles, return_inverse=True)
    faces = np.concatenate([mesh.face_ids[behind], mesh.face_ids[before]])
    return replace(
        mesh,
        points=mesh.points[used], triangles=rows.reshape(-1, 3), face_ids=faces,
        uv_points=None, uv_triangles=None, surfaces=(), turned_faces=None, solid_ids=None,
        edge_segments=None, edge_ids=None, edge_shares=None, vertex_ids=None, mid_points=None,
        facts=None,
        sizes=None if mesh.sizes is None else mesh.sizes[used],
        inverse_sizes=None,
    )  # fmt: skip


def shares_faces(mesh: SurfaceMesh) -> bool:
    """Do two solids of the model have a face in common?"""
    return mesh.solid_ids is not None and bool((mesh.solid_ids >= 0).all(axis=1).any())
