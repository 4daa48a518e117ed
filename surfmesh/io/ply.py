"""Binary PLY in double precision, with ``size`` on vertices.

Faces have their corners and, where there are colours, red, green and blue. Nothing else is put on
them, as meshio reads no binary file whose faces have more than their corners. Numbers of faces,
names and the rest stand in comments.
"""

from pathlib import Path

import numpy as np

from surfmesh.errors import FileFormatError
from surfmesh.io.colours import NO_COLOUR, triangle_colours
from surfmesh.io.group_record import group_fields, group_lines
from surfmesh.io.ply_reading import read_ply
from surfmesh.result.surface_mesh import SurfaceMesh

VERTEX = [("x", "<f8"), ("y", "<f8"), ("z", "<f8")]
FACE = [("count", "u1"), ("corners", "<i4", 3)]
COLOUR = [("red", "u1"), ("green", "u1"), ("blue", "u1")]


def write(mesh: SurfaceMesh, path: Path) -> None:
    sized = mesh.sizes is not None
    vertices = np.empty(len(mesh.points), VERTEX + [("size", "<f8")] * sized)
    vertices["x"], vertices["y"], vertices["z"] = mesh.points.T
    if sized:
        vertices["size"] = mesh.sizes
    colours = triangle_colours(mesh)
    channels = [] if colours is None else COLOUR
    faces = np.empty(len(mesh.triangles), FACE + channels)
    if colours is not None:
        for channel, (name, _) in enumerate(COLOUR):
            faces[name] = np.where(colours[:, channel] < 0, NO_COLOUR, colours[:, channel])
    faces["count"], faces["corners"] = 3, mesh.triangles
    header = [
        "ply",
        "format binary_little_endian 1.0",
        "comment surfmesh",
        *(f"comment {line}" for line in group_lines(mesh, numbered=True)),
        f"element vertex {len(vertices)}",
        *(f"property double {name}" for name in vertices.dtype.names or ()),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        *(f"property uchar {name}" for name, _ in channels),
        "end_header",
    ]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode("ascii") + b"\n")
        file.write(vertices.data)  # tofile() hides a full disk
        file.write(faces.data)


def read(path: Path) -> SurfaceMesh:
    """Vertices and triangles, ``size`` and ``face_id``; faces of four corners are cut in two."""
    found = read_ply(path)
    corners = found.corners()
    if corners is None or any(axis not in found.vertex for axis in "xyz"):
        raise FileFormatError(f"{path}: there are no triangles in it")
    if corners.shape[1] == 4:
        corners = np.vstack((corners[:, [0, 1, 2]], corners[:, [2, 3, 0]]))
    elif corners.shape[1] != 3:
        raise FileFormatError(f"{path}: holds faces that are not triangles")
    face_ids = found.face.get("face_id")
    fields = group_fields(found.lines, len(corners), face_ids)
    return SurfaceMesh(
        points=np.column_stack([found.vertex[axis] for axis in "xyz"]),
        triangles=corners,
        sizes=found.vertex.get("size"),
        **{"face_ids": face_ids} | fields,
    )
