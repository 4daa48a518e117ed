"""Binary STL: three float32 corners a triangle, nothing shared, nothing named."""

from pathlib import Path

import numpy as np

from surfmesh.io.to_trimesh import read_with_trimesh
from surfmesh.surface_mesh import SurfaceMesh

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write(mesh: SurfaceMesh, path: Path) -> None:
    records = np.zeros(len(mesh.triangles), RECORD)
    a, b, c = (mesh.points[corner] for corner in mesh.triangles.T)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    records["normal"] = normals / np.where(lengths > 0, lengths, 1.0)
    records["corners"] = mesh.points[mesh.triangles]
    with open(path, "wb") as file:
        file.write(b"surfmesh, binary STL".ljust(80))
        file.write(np.uint32(len(records)).tobytes())
        records.tofile(file)


def read(path: Path) -> SurfaceMesh:
    """Corners with equal coordinates become one vertex; triangles that this flattens go."""
    found = read_with_trimesh(path)
    corners = np.asarray(found.vertices)[found.faces].reshape(-1, 3)
    points, triangles = _welded(corners)
    a, b, c = triangles.T
    whole = (a != b) & (b != c) & (c != a)
    lost = len(whole) - int(whole.sum())
    points, triangles = _welded(points[triangles[whole]].reshape(-1, 3))
    warnings = [f"{lost} triangles without area in single precision left out"] if lost else []
    return SurfaceMesh(points=points, triangles=triangles, warnings=warnings)


def _welded(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distinct points in order of first use, and the triangles (m, 3) of them."""
    order = np.lexsort(corners.T)  # stable: the first of equals is the earliest
    ranked = corners[order]
    new = np.ones(len(ranked), bool)
    new[1:] = (ranked[1:] != ranked[:-1]).any(axis=1)
    label = np.empty(len(corners), np.int64)
    label[order] = np.cumsum(new) - 1
    first = order[new]
    by_use = np.argsort(first)
    rank = np.empty(len(first), np.int64)
    rank[by_use] = np.arange(len(first))
    return corners[first[by_use]], rank[label].reshape(-1, 3)
