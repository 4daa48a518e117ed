"""Binary PLY in double precision, with ``size`` on vertices, ``face_id`` and ``alpha`` on faces."""

from pathlib import Path

import numpy as np

from surfmesh.io.to_trimesh import read_with_trimesh
from surfmesh.quality.shape import alpha
from surfmesh.surface_mesh import SurfaceMesh

VERTEX = [("x", "<f8"), ("y", "<f8"), ("z", "<f8")]
FACE = [("count", "u1"), ("corners", "<i4", 3), ("face_id", "<i4"), ("alpha", "<f8")]


def write(mesh: SurfaceMesh, path: Path) -> None:
    sized = mesh.sizes is not None
    vertices = np.empty(len(mesh.points), VERTEX + [("size", "<f8")] * sized)
    vertices["x"], vertices["y"], vertices["z"] = mesh.points.T
    if sized:
        vertices["size"] = mesh.sizes
    faces = np.empty(len(mesh.triangles), FACE)
    faces["count"], faces["corners"] = 3, mesh.triangles
    faces["face_id"], faces["alpha"] = mesh.face_ids, alpha(mesh)
    header = [
        "ply",
        "format binary_little_endian 1.0",
        "comment surfmesh",
        f"element vertex {len(vertices)}",
        *(f"property double {name}" for name in vertices.dtype.names),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "property int face_id",
        "property double alpha",
        "end_header",
    ]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode("ascii") + b"\n")
        vertices.tofile(file)
        faces.tofile(file)


def read(path: Path) -> SurfaceMesh:
    found = read_with_trimesh(path)
    return SurfaceMesh(
        points=found.vertices,
        triangles=found.faces,
        sizes=_column(found, "vertex", "size"),
        face_ids=_column(found, "face", "face_id"),
    )


def _column(found, element: str, name: str) -> np.ndarray | None:
    """A property that trimesh keeps only in the raw data of the file."""
    raw = found.metadata.get("_ply_raw", {}).get(element, {}).get("data")
    if raw is None or name not in (raw.dtype.names or ()):
        return None
    return np.asarray(raw[name]).reshape(-1)
