"""As a trimesh.Trimesh, and from what trimesh reads."""

from pathlib import Path

import numpy as np
import trimesh

from surfmesh.io.colours import NO_COLOUR, triangle_colours
from surfmesh.surface_mesh import SurfaceMesh


def to_trimesh(mesh: SurfaceMesh) -> trimesh.Trimesh:
    """Trimesh with vertex attribute ``size`` and face attribute ``face_id``; nothing merged.

    Coloured where faces or solids are; corners alone for order 2.
    """
    colours = triangle_colours(mesh)
    sizes = {} if mesh.sizes is None else {"size": mesh.sizes.copy()}
    return trimesh.Trimesh(
        vertices=mesh.points.copy(),
        faces=mesh.triangles.astype(np.int64),
        vertex_attributes=sizes,
        face_attributes={"face_id": mesh.face_ids.copy()},
        face_colors=None if colours is None else np.where(colours < 0, NO_COLOUR, colours),
        process=False,
        validate=False,
    )


def read_with_trimesh(path: Path) -> trimesh.Trimesh:
    """What trimesh finds in ``path`` as one mesh, vertices kept in their order."""
    return trimesh.load_mesh(path, process=False, maintain_order=True)
