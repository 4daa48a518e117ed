"""Medit's .mesh, as text: what mmg, FreeFem, tetwild and others take.

The reference of a triangle is the number of its face from 1, that of a segment the number of its
CAD edge; vertices of CAD are ``Corners``. Coordinates have 17 digits; names, colours and solids
stand in comments before ``End``. Triangles of order 2 are written by their corners.
Format: Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253, 2001.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.group_record import group_fields, group_lines
from surfmesh.io.numbers_of_groups import named_faces
from surfmesh.io.text_columns import write_rows
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.surface_mesh import SurfaceMesh

WIDTHS = {"Vertices": 4, "Triangles": 4, "Edges": 3}  # words of a row
OTHER_CELLS = ("Tetrahedra", "Quadrilaterals", "Hexahedra", "Prisms", "Pyramids")


def write(mesh: SurfaceMesh, path: Path) -> None:
    vertices = np.empty(0, np.int64) if mesh.vertex_ids is None else mesh.vertex_ids
    corners = np.unique(vertices[vertices >= 0])
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write(f"MeshVersionFormatted 2\n\nDimension 3\n\nVertices\n{len(mesh.points)}\n")
        references = np.zeros((len(mesh.points), 1))
        write_rows(file, "%.17g %.17g %.17g %d\n", np.hstack((mesh.points, references)))
        file.write(f"\nTriangles\n{len(mesh.triangles)}\n")
        rows = np.column_stack((mesh.triangles, mesh.face_ids)) + 1
        write_rows(file, "%d %d %d %d\n", rows)
        if mesh.edge_ids is not None and mesh.edge_segments is not None and len(mesh.edge_ids):
            file.write(f"\nEdges\n{len(mesh.edge_ids)}\n")
            write_rows(file, "%d %d %d\n", np.column_stack((mesh.edge_segments, mesh.edge_ids)) + 1)
        if len(corners):
            file.write(f"\nCorners\n{len(corners)}\n")
            write_rows(file, "%d\n", corners[:, None] + 1)
        file.writelines(f"# {line}\n" for line in group_lines(mesh, numbered=True))
        file.write("\nEnd\n")


def read(path: Path) -> SurfaceMesh:
    """Vertices, triangles and edges of a file of three dimensions, or two."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    words = [word for line in lines for word in line.partition("#")[0].split()]
    if not words or words[0] != "MeshVersionFormatted":
        raise FileFormatError(f"{path}: does not start with MeshVersionFormatted")
    if words[-1] != "End":
        raise FileFormatError(f"{path}: is cut: it does not end with End")
    dimension = int(words[words.index("Dimension") + 1])
    if dimension not in (2, 3):
        raise FileFormatError(f"{path}: Dimension must be 2 or 3")
    for cells in OTHER_CELLS:
        if _rows(path, words, cells, 0) is not None:
            raise FileFormatError(f"{path}: holds {cells} beside triangles")
    vertices = _rows(path, words, "Vertices", dimension + 1)
    table = _rows(path, words, "Triangles", WIDTHS["Triangles"])
    if vertices is None or table is None:
        raise FileFormatError(f"{path}: there are no triangles in it")
    points = np.zeros((len(vertices), 3))
    points[:, :dimension] = vertices[:, :dimension].astype(float)
    triangles = table.astype(np.int64)
    face_ids = triangles[:, 3] - 1
    fields = group_fields(lines, len(triangles), None)
    if not fields:
        count = int(face_ids.max(initial=-1)) + 1
        face_ids, names, warnings = named_faces(face_ids, {}, count)
        fields = {"face_ids": face_ids, "groups": MeshGroups(face_names=names)}
        fields["warnings"] = warnings
        edges = _rows(path, words, "Edges", WIDTHS["Edges"])
        if edges is not None:
            numbers = edges.astype(np.int64) - 1
            fields |= {"edge_segments": numbers[:, :2], "edge_ids": numbers[:, 2]}
    return SurfaceMesh(points=points, triangles=triangles[:, :3] - 1, **fields)


def _rows(path: Path, words: list[str], name: str, width: int) -> NDArray | None:
    """The words (n, width) below a keyword, None where it is not there or has none."""
    if name not in words:
        return None
    at = words.index(name) + 1
    count = int(words[at]) if at < len(words) else 0
    if count < 0 or at + 1 + count * width > len(words):
        raise FileFormatError(f"{path}: has fewer than {count} rows of {name}")
    return np.array(words[at + 1 : at + 1 + count * width]).reshape(count, width) if count else None
