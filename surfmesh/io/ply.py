"""Binary PLY in double precision, with ``size`` on vertices, ``face_id`` and ``alpha`` on faces.

Colours are those of faces, red, green and blue; names and the rest stand in comments.
"""

from pathlib import Path

import numpy as np

from surfmesh.io.colours import NO_COLOUR, triangle_colours
from surfmesh.io.group_record import group_fields, group_lines
from surfmesh.io.to_trimesh import read_with_trimesh
from surfmesh.quality.shape import alpha
from surfmesh.surface_mesh import SurfaceMesh

VERTEX = [("x", "<f8"), ("y", "<f8"), ("z", "<f8")]
FACE = [("count", "u1"), ("corners", "<i4", 3), ("face_id", "<i4"), ("alpha", "<f8")]

COLOUR = [("red", "u1"), ("green", "u1"), ("blue", "u1")]


def write(mesh: SurfaceMesh, path: Path) -> None:
    sized = mesh.sizes is not None
    vertices = np.empty(len(mesh.points), VERTEX + [("size", "<f8")] * sized)
    vertices["x"], vertices["y"], vertices["z"] = mesh.points.T
    if sized:
        vertices["size"] = mesh.sizes
    colours = triangle_colours(mesh)
    coloured = colours is not None
    faces = np.empty(len(mesh.triangles), FACE + COLOUR * coloured)
    if coloured:
        for channel, (name, _) in enumerate(COLOUR):
            faces[name] = np.where(colours[:, channel] < 0, NO_COLOUR, colours[:, channel])
    faces["count"], faces["corners"] = 3, mesh.triangles
    faces["face_id"], faces["alpha"] = mesh.face_ids, alpha(mesh)
    header = [
        "ply",
        "format binary_little_endian 1.0",
        "comment surfmesh",
        *(f"comment {line}" for line in group_lines(mesh, numbered=True)),
        f"element vertex {len(vertices)}",
        *(f"property double {name}" for name in vertices.dtype.names),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "property int face_id",
        "property double alpha",
        *(f"property uchar {name}" for name, _ in COLOUR * coloured),
        "end_header",
    ]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode("ascii") + b"\n")
        file.write(vertices.data)  # tofile() hides a full disk
        file.write(faces.data)


def read(path: Path) -> SurfaceMesh:
    found = read_with_trimesh(path)
    face_ids = _column(found, "face", "face_id")
    with open(path, "rb") as file:
        head = file.read().partition(b"end_header")[0].decode(errors="replace")
    fields = group_fields(head.splitlines(), face_ids)
    return SurfaceMesh(
        points=found.vertices,
        triangles=found.faces,
        sizes=_column(found, "vertex", "size"),
        face_ids=face_ids,
        **fields,
    )


def _column(found, element: str, name: str) -> np.ndarray | None:
    """A property that trimesh keeps only in the raw data of the file."""
    raw = found.metadata.get("_ply_raw", {}).get(element, {}).get("data")
    if raw is None or name not in (raw.dtype.names or ()):
        return None
    return np.asarray(raw[name]).reshape(-1)
