"""The same triangles with a vertex of its own for each face that meets there.

What differs from face to face, as curvature does, is one value a vertex then without a jump being
smeared over the triangles beside it.
"""

import numpy as np

from surfmesh.result.quadratic_triangles import edge_rows
from surfmesh.result.surface_mesh import SurfaceMesh


def faces_apart(mesh: SurfaceMesh) -> SurfaceMesh:
    """Vertices are doubled between faces; lines along edges keep to one of their copies."""
    pairs = np.column_stack((np.repeat(mesh.face_ids, 3), mesh.triangles.reshape(-1)))
    kept, corners = np.unique(pairs, axis=0, return_inverse=True)
    if len(kept) == len(mesh.points):
        return mesh
    vertices = kept[:, 1]
    copy = np.zeros(len(mesh.points), np.int64)
    copy[vertices[::-1]] = np.arange(len(vertices))[::-1]
    segments, ids = mesh.edge_segments, mesh.vertex_ids
    apart = mesh.replaced(
        points=mesh.points[vertices],
        triangles=corners.reshape(-1, 3),
        sizes=None if mesh.sizes is None else mesh.sizes[vertices],
        mid_points=None,
        edge_segments=None if segments is None else copy[segments],
        vertex_ids=None if ids is None else np.where(ids >= 0, copy[ids], -1),
    )
    if mesh.mid_points is None:
        return apart
    rows = edge_rows(mesh.connectivity, vertices[apart.edges])
    return apart.replaced(mid_points=mesh.mid_points[rows])
