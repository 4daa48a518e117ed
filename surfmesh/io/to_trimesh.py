"""As a trimesh.Trimesh, and from what trimesh reads."""

import logging
from io import BytesIO
from pathlib import Path

import numpy as np
import trimesh

from surfmesh.io.colours import NO_COLOUR, triangle_colours
from surfmesh.result.surface_mesh import SurfaceMesh

# what trimesh finds odd goes to the handlers that a program has set up, not to the console
logging.getLogger("trimesh").addHandler(logging.NullHandler())


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


def read_with_trimesh(path: Path, data: bytes) -> trimesh.Trimesh:
    """What trimesh finds in ``data``, the content of ``path``, as one mesh; vertices keep their
    order.

    No other file is opened, whatever ``data`` name: textures and materials are passed over.
    """
    return trimesh.load_mesh(
        BytesIO(data),
        file_type=path.suffix.lower()[1:],
        resolver=None,
        process=False,
        maintain_order=True,
        skip_materials=True,
    )
