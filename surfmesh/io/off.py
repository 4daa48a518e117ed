"""Object File Format: text with 17 digits; faces, names and colours stand in comments."""

from pathlib import Path

import numpy as np

from surfmesh.errors import FileFormatError
from surfmesh.io.group_record import group_fields, group_lines, require_last_line
from surfmesh.io.text_columns import write_rows
from surfmesh.result.surface_mesh import SurfaceMesh


def write(mesh: SurfaceMesh, path: Path) -> None:
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("OFF\n")
        file.writelines(f"# {line}\n" for line in group_lines(mesh, numbered=True))
        file.write(f"{len(mesh.points)} {len(mesh.triangles)} 0\n")
        write_rows(file, "%.17g %.17g %.17g\n", mesh.points)
        write_rows(file, "3 %d %d %d\n", mesh.triangles)


def read(path: Path) -> SurfaceMesh:
    """Vertices and triangles; colours on the lines of triangles are passed over."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    rows = [row for row in (line.partition("#")[0].split() for line in lines) if row]
    if not rows or not rows[0][0].endswith("OFF"):
        raise FileFormatError(f"{path}: does not start with OFF")
    head = rows[0][1:]
    rows = rows[1:] if len(head) < 2 else [head, *rows[1:]]
    if not rows or len(rows[0]) < 2:
        raise FileFormatError(f"{path}: has no numbers of vertices and triangles")
    points, triangles = int(rows[0][0]), int(rows[0][1])
    if points < 0 or triangles < 0:
        raise FileFormatError(f"{path}: announces {min(points, triangles)} vertices or triangles")
    if len(rows) < 1 + points + triangles:
        raise FileFormatError(f"{path}: ends before its last triangle")
    corners = rows[1 + points : 1 + points + triangles]
    if any(row[0] != "3" for row in corners):
        raise FileFormatError(f"{path}: holds faces that are not triangles")
    fields = group_fields(lines, triangles)
    if fields:
        require_last_line(path)
    return SurfaceMesh(
        points=np.array([row[:3] for row in rows[1 : 1 + points]], float).reshape(-1, 3),
        triangles=np.array([row[1:4] for row in corners], np.int64).reshape(-1, 3),
        **fields,
    )
