"""SU2's native mesh, as text: elements, points, and boundaries as markers by name.

A planar domain (all z are 0) has two dimensions: its triangles are the elements, its named edges
the markers. A surface in space has three: its faces are the markers, and there are no elements, for
a program that fills it. Rows end with the number of the triangle, which readers pass over. Points
are counted from 0, coordinates have 17 digits. What markers cannot hold stands in comments at the
end; order 2 is not known to the format.
Format: SU2 documentation, "Mesh File"; element types are those of VTK.
"""

from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.group_record import (
    group_fields,
    group_lines,
    numbers_by_label,
    require_last_line,
    unique_labels,
)
from surfmesh.io.text_columns import write_rows
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.surface_mesh import SurfaceMesh

LINE, TRIANGLE = 3, 5  # of VTK
LONGEST = 60  # characters of a marker
OURS = "% surfmesh"  # the first line; the last ones are the record of groups then


def write(mesh: SurfaceMesh, path: Path) -> None:
    flat = not mesh.points[:, 2].any()
    numbers = np.arange(len(mesh.triangles))[:, None]
    numbered = np.hstack((mesh.triangles, numbers))
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write(f"{OURS}\nNDIME= {2 if flat else 3}\n")
        if flat:
            file.write(f"NELEM= {len(numbered)}\n")
            write_rows(file, f"{TRIANGLE} %d %d %d %d\n", numbered)
        file.write(f"NPOIN= {len(mesh.points)}\n")
        points = np.hstack(
            (mesh.points[:, : 2 if flat else 3], np.arange(len(mesh.points))[:, None])
        )
        write_rows(file, "%.17g " * (2 if flat else 3) + "%d\n", points)
        if flat:
            markers, row = list(_edges(mesh)), f"{LINE} %d %d\n"
        else:
            by_face = _by_name(mesh.face_ids, mesh.groups.face_label, numbered)
            markers, row = list(by_face), f"{TRIANGLE} %d %d %d %d\n"
        file.write(f"NMARK= {len(markers)}\n")
        for name, rows in markers:
            file.write(f"MARKER_TAG= {name}\nMARKER_ELEMS= {len(rows)}\n")
            write_rows(file, row, rows)
        file.writelines(f"% {line}\n" for line in group_lines(mesh, numbered=True))


def _edges(mesh: SurfaceMesh) -> Iterator[tuple[str, NDArray]]:
    """Names and segments, edges of one name together; without edges: the whole rim."""
    if mesh.edge_ids is not None and mesh.edge_segments is not None and len(mesh.edge_ids):
        yield from _by_name(mesh.edge_ids, mesh.groups.edge_label, mesh.edge_segments)
    else:
        rim = mesh.boundary_edges
        if len(rim):
            yield "boundary", rim


def _by_name(
    numbers: NDArray, label: Callable[[int], str], rows: NDArray
) -> Iterator[tuple[str, NDArray]]:  # fmt: skip
    """Names and rows, what has one name together."""
    names = numbers_by_label(np.unique(numbers).tolist(), label)
    for name, members in zip(unique_labels(names, LONGEST), names.values()):
        yield name, rows[np.isin(numbers, members)]


def read(path: Path) -> SurfaceMesh:
    """Triangles: the elements of two dimensions, the markers of three."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    points, blocks = _content(path, lines)
    kind = "" if any(not name and len(rows) for name, rows in blocks) else None
    faces: dict[str, int] = {}
    rows, face_ids = [], []
    for name, block in blocks:
        if len(block) and (kind is None or name == kind) and int(block[0][0]) != LINE:
            if any(int(row[0]) != TRIANGLE or len(row) < 4 for row in block):
                raise FileFormatError(f"{path}: holds elements that are not triangles")
            rows += [row[1:] for row in block]
            face_ids += [faces.setdefault(name, len(faces))] * len(block)
    if not rows:
        raise FileFormatError(f"{path}: there are no triangles in it")
    triangles = np.array([row[:3] for row in rows], np.int64)
    record = group_fields(lines, len(rows))
    if record:
        require_last_line(path)
        order = np.argsort([int(row[3]) for row in rows], kind="stable")
        return SurfaceMesh(points=points, triangles=triangles[order], **record)
    if lines and lines[0].startswith(OURS):
        raise FileFormatError(f"{path}: is cut: its last comments, the record of groups, are gone")
    groups = MeshGroups(face_names=tuple(faces))
    return SurfaceMesh(points=points, triangles=triangles, face_ids=face_ids, groups=groups)


Block = tuple[str, list[list[str]]]  # a marker, or '' for the elements; the words of its rows


def _content(path: Path, lines: list[str]) -> tuple[NDArray, list[Block]]:
    """Points (n, 3), and the elements and markers with their rows."""
    kept = (line.strip() for line in lines)
    rows = iter([line for line in kept if line and not line.startswith("%")])
    dimension, points, blocks, marker = 0, np.empty((0, 3)), [], ""
    for line in rows:
        word, _, value = (part.strip() for part in line.partition("="))
        if word == "NDIME":
            dimension = int(value)
        elif word == "NPOIN":
            found = _below(path, rows, int(value.split()[0]), word)
            points = np.zeros((len(found), 3))
            for axis in range(dimension):
                points[:, axis] = [float(row[axis]) for row in found]
        elif word == "MARKER_TAG":
            marker = value
        elif word in ("NELEM", "MARKER_ELEMS"):
            found = _below(path, rows, int(value), word)
            blocks.append(("" if word == "NELEM" else marker, found))
    if dimension not in (2, 3):
        raise FileFormatError(f"{path}: NDIME must be 2 or 3")
    return points, blocks


def _below(path: Path, rows: Iterator[str], count: int, word: str) -> list[list[str]]:
    """The words of the next ``count`` rows."""
    found = [line.split() for line in islice(rows, max(count, 0))]
    if len(found) != count:
        raise FileFormatError(f"{path}: has {len(found)} of {count} rows of {word}")
    return found
