"""Wavefront OBJ: text with 17 digits, a group wherever the face changes."""

from pathlib import Path

import numpy as np

from surfmesh.errors import FileFormatError
from surfmesh.io.group_record import MARK, group_fields, group_lines, require_last_line
from surfmesh.io.text_columns import write_rows
from surfmesh.result.surface_mesh import SurfaceMesh


def write(mesh: SurfaceMesh, path: Path) -> None:
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write("# surfmesh\n")
        file.writelines(f"# {line}\n" for line in group_lines(mesh, numbered=True))
        written = 0
        write_rows(file, "v %.17g %.17g %.17g\n", mesh.points)
        for run in np.split(mesh.triangles, np.flatnonzero(np.diff(mesh.face_ids)) + 1):
            face = int(mesh.face_ids[written])
            name = "_".join(mesh.face_name(face).split())
            file.write(f"# face_id {face}\ng {name}\n")
            write_rows(file, "f %d %d %d\n", run + 1)
            written += len(run)


def read(path: Path) -> SurfaceMesh:
    """Vertices and triangles; normals, textures and materials are passed over."""
    points, triangles, face_ids = [], [], []
    face, marked, record = 0, False, []
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, 1):
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                points.append(_numbers(float, words[1:4], path, number))
            elif words[0] == "f":
                if len(words) != 4:
                    raise FileFormatError(f"{path}: line {number} is not a triangle")
                corners = [word.partition("/")[0] for word in words[1:]]
                triangles.append(_numbers(int, corners, path, number))
                if min(triangles[-1]) < 0:  # counted from the last vertex so far
                    last = len(points) + 1
                    triangles[-1] = [i + last if i < 0 else i for i in triangles[-1]]
                face_ids.append(face)
            elif words[0] == "#" and MARK in line:
                record.append(line)
            elif words[:2] == ["#", "face_id"]:
                face, marked = int(words[2]), True
            elif words[0] == "g" and not marked and triangles:
                face += 1
    fields = group_fields(record, len(triangles))  # which knows how many there are to be
    if fields:
        require_last_line(path)
    fields.setdefault("face_ids", face_ids)
    return SurfaceMesh(
        points=np.array(points, float).reshape(-1, 3),
        triangles=np.array(triangles, np.int64).reshape(-1, 3) - 1,
        **fields,
    )


def _numbers(kind: type, words: list[str], path: Path, line: int) -> list:
    try:
        x, y, z = map(kind, words)
    except ValueError:
        raise FileFormatError(f"{path}: line {line} does not hold three numbers") from None
    return [x, y, z]
