"""The same triangles with a vertex of its own for each face that meets there.

What differs from face to face, as curvature does, is one value a vertex then without a jump being
smeared over the triangles beside it.
"""

import numpy as np

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
    links = {}
    if mesh.edge_segments is not None:
        links["edge_segments"] = copy[mesh.edge_segments]
    if mesh.vertex_ids is not None:
        links["vertex_ids"] = np.where(mesh.vertex_ids >= 0, copy[mesh.vertex_ids], -1)
    return mesh.replaced(
        points=mesh.points[vertices],
        triangles=corners.reshape(-1, 3),
        sizes=None if mesh.sizes is None else mesh.sizes[vertices],
        mid_points=None,
        **links,
    )
