"""STL: three corners a triangle, nothing shared.

Binary: float32, one body. ASCII: 17 digits, one ``solid`` with a name for each solid of the
mesh, a face between two solids in both, once each way round; or one for each name of a face, as
OpenFOAM's snappyHexMesh and surfaceCheck take patches.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.group_record import numbers_by_label, unique_labels
from surfmesh.io.welding import welded
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.surface_mesh import SurfaceMesh

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
LONGEST = 80  # characters of a name of faces: letters, digits, "_", "-" and "."
HEADER = 80  # bytes, and four for the number of triangles
LINES = 10_000  # triangles formatted together
FACET = (
    "facet normal %.9g %.9g %.9g\n outer loop\n"
    + "  vertex %.17g %.17g %.17g\n" * 3
    + " endloop\nendfacet\n"
)


def write(mesh: SurfaceMesh, path: Path) -> None:
    records = np.zeros(len(mesh.triangles), RECORD)
    records["normal"], records["corners"] = _normals(mesh), mesh.points[mesh.triangles]
    unit = f", unit {mesh.groups.unit}" if mesh.groups.unit else ""
    with open(path, "wb") as file:
        file.write(f"surfmesh, binary STL{unit}".encode("ascii", "replace").ljust(HEADER))
        file.write(np.uint32(len(records)).tobytes())
        file.write(records.data)  # tofile() hides a full disk


def write_ascii(mesh: SurfaceMesh, path: Path, solids: str = "solids") -> None:
    normals, corners = _normals(mesh), mesh.points[mesh.triangles].reshape(-1, 9)
    backwards = corners[:, [6, 7, 8, 3, 4, 5, 0, 1, 2]]
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        for name, own, turned in _by_face(mesh) if solids == "faces" else _by_solid(mesh):
            name = " ".join(name.split()).replace("endsolid", "end-solid")
            file.write(f"solid {name}\n")
            sign = np.where(turned, -1.0, 1.0)[:, None]
            rows = np.hstack((sign * normals, np.where(turned[:, None], backwards, corners)))[own]
            for start in range(0, len(rows), LINES):
                block = rows[start : start + LINES]
                file.write((FACET * len(block)) % tuple(block.ravel().tolist()))
            file.write(f"endsolid {name}\n")


Body = tuple[str, NDArray, NDArray]  # its name, which triangles it has, which of them are turned


def _by_solid(mesh: SurfaceMesh) -> Iterator[Body]:
    """Bodies of solids, and of what belongs to none."""
    count = len(mesh.triangles)
    sides = np.full((count, 2), -1) if mesh.solid_ids is None else mesh.solid_ids
    free = np.all(sides < 0, axis=1)
    if free.any():
        yield "surface", free, np.zeros(count, bool)
    for solid in np.unique(sides[sides >= 0]).tolist():
        behind, before = (np.equal(side, solid) for side in sides.T)
        yield mesh.groups.solid_label(solid), behind | before, ~behind


def _by_face(mesh: SurfaceMesh) -> Iterator[Body]:
    """Bodies of the names of faces: faces of one name together."""
    names = numbers_by_label(np.unique(mesh.face_ids).tolist(), mesh.groups.face_label)
    labels = unique_labels(names, LONGEST, allowed="-.")
    for label, faces in zip(labels, names.values()):
        yield label, np.isin(mesh.face_ids, faces), np.zeros(len(mesh.triangles), bool)


def _normals(mesh: SurfaceMesh) -> NDArray[np.float64]:
    a, b, c = (mesh.points[corner] for corner in mesh.triangles.T)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / np.where(lengths > 0, lengths, 1.0)


def read(path: Path) -> SurfaceMesh:
    """Corners with equal coordinates become one vertex; triangles that this flattens go."""
    with open(path, "rb") as file:
        head = file.read(HEADER + 4)
        count = int.from_bytes(head[HEADER:], "little")
        if path.stat().st_size != HEADER + 4 + RECORD.itemsize * count:
            if head.lstrip().lower().startswith(b"solid"):
                return _read_ascii(path)
            raise FileFormatError(
                f"{path}: the .stl file is damaged or incomplete: it does not hold the {count} "
                "triangles that it announces, and is no text"
            )
        corners = np.fromfile(file, RECORD, count)["corners"].astype(np.float64).reshape(-1, 3)
    points, triangles = welded(corners)
    a, b, c = triangles.T
    whole = (a != b) & (b != c) & (c != a)
    lost = len(whole) - int(whole.sum())
    points, triangles = welded(points[triangles[whole]].reshape(-1, 3))
    warnings = [f"{lost} triangles without area in single precision left out"] if lost else []
    return SurfaceMesh(points=points, triangles=triangles, warnings=warnings)


def _read_ascii(path: Path) -> SurfaceMesh:
    """Solids by their names; a triangle that two of them have, one each way, lies between them."""
    names, words, counts, opened = [], [], [], False
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            keyword, _, rest = line.strip().partition(" ")
            keyword = keyword.lower()
            if keyword == "vertex":
                words += rest.split()
            elif keyword == "solid":
                names.append(rest.strip())
                counts.append(len(words))
                opened = True
            elif keyword == "endsolid":
                opened = False
    if opened or not names or len(words) % 9:
        raise FileFormatError(f"{path}: the ASCII .stl file is damaged or incomplete")
    points, triangles = welded(np.array(words, float).reshape(-1, 3))
    solids = np.repeat(np.arange(len(names)), np.diff(counts, append=len(words)) // 9)
    first, second = _between_two(triangles, solids)
    sides = np.full((len(triangles), 2), -1)
    sides[:, 0] = solids
    sides[first, 1] = solids[second]
    kept = np.delete(np.arange(len(triangles)), second)
    groups = MeshGroups(solid_names=tuple(names))
    return SurfaceMesh(
        points=points, triangles=triangles[kept], solid_ids=sides[kept], groups=groups
    )  # fmt: skip


def _between_two(
    triangles: NDArray[np.int64], solids: NDArray[np.int64]
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows (k,) and (k,) of triangles that come just twice, in two solids and opposite ways."""
    order = np.lexsort(np.sort(triangles, axis=1).T)
    ranked = np.sort(triangles[order], axis=1)
    start = np.flatnonzero(np.append(True, (ranked[1:] != ranked[:-1]).any(axis=1)))
    start = start[np.diff(start, append=len(order)) == 2]
    first, second = order[start], order[start + 1]
    opposite = _parity(triangles[first]) != _parity(triangles[second])
    between = opposite & (solids[first] != solids[second])
    return first[between], second[between]


def _parity(triangles: NDArray[np.int64]) -> NDArray[np.bool_]:
    """(k,) do the numbers of corners (k, 3) rise, but for one step, on the way round?"""
    return (triangles < np.roll(triangles, -1, axis=1)).sum(axis=1) == 2
