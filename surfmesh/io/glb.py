"""Binary glTF through trimesh: single precision, positions and triangles."""

from pathlib import Path

from surfmesh.io.to_trimesh import read_with_trimesh, to_trimesh
from surfmesh.surface_mesh import SurfaceMesh


def write(mesh: SurfaceMesh, path: Path) -> None:
    bare = to_trimesh(mesh)
    bare.vertex_attributes.clear()  # glTF wants names of its own for them
    path.write_bytes(bare.export(file_type="glb"))


def read(path: Path) -> SurfaceMesh:
    found = read_with_trimesh(path)
    return SurfaceMesh(points=found.vertices, triangles=found.faces)
