"""Tetrahedra to files; names of solids, faces and edges are groups there.

.inp: C3D4 or C3D10 by solid; each name of a face is a surface of sides and a set of nodes, each
      edge a set of nodes (CalculiX and Abaqus)
.msh: Gmsh's MSH 4.1, physical groups in three dimensions, two and one
.su2: elements, and names of faces as markers; corners alone
.mesh: Medit; references are solid + 1 and face + 1; corners alone
.vtu: ``solid_id``; names of solids and faces as a JSON text in field data
"""

import json
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.atomic import replacing
from surfmesh.io.group_record import numbers_by_label, unique_labels
from surfmesh.io.inp import NAME, nodes_of_edges, write_elements, write_nodes, write_set
from surfmesh.io.msh import write_filled
from surfmesh.io.text_columns import write_rows
from surfmesh.io.xml_writing import Content, write_grid
from surfmesh.volume.volume_mesh import VolumeMesh

SOLID_ELEMENT = {1: "C3D4", 2: "C3D10"}
CORNERS_ALONE = (".su2", ".mesh")
TETRAHEDRON, TRIANGLE = 10, 5  # of VTK


def save(mesh: VolumeMesh, path: str | Path) -> Path:
    """Write ``mesh`` to ``path``; all of it or nothing."""
    path = Path(path)
    write = _WRITERS.get(path.suffix.lower())
    if write is None:
        known = " ".join(_WRITERS)
        raise FileFormatError(f"{path}: extension '{path.suffix}' is not known; known are {known}")
    if mesh.order == 2 and path.suffix.lower() in CORNERS_ALONE:
        warnings.warn(f"{path}: {path.suffix} holds the corners alone", stacklevel=3)
    with replacing(path) as temporary:
        write(mesh, temporary)
    return path


def _write_vtu(mesh: VolumeMesh, path: Path) -> None:
    text = json.dumps(mesh.surface.groups.plain()).encode()
    cells = {"solid_id": mesh.solid_ids}
    field = {"surfmesh_groups": np.frombuffer(text, np.uint8)}
    write_grid(Content(mesh.nodes, mesh.elements, {}, cells, field), path)


def _write_msh(mesh: VolumeMesh, path: Path) -> None:
    filled = {i: mesh.elements[mesh.solid_ids == i] for i in np.unique(mesh.solid_ids).tolist()}
    write_filled(mesh.surface, mesh.nodes, filled, path)


def _write_inp(mesh: VolumeMesh, path: Path) -> None:
    surface, groups = mesh.surface, mesh.surface.groups
    solids = np.unique(mesh.solid_ids).tolist()
    faces = list(_faces_by_name(mesh))
    labels = unique_labels(
        [*(groups.solid_label(i) for i in solids), *(name for name, _ in faces)], NAME
    )
    with open(path, "w", encoding="ascii", newline="\n") as file:
        unit = f", unit {groups.unit}" if groups.unit else ""
        file.write(f"** tetrahedra of surfmesh{unit}\n")
        write_nodes(file, mesh.nodes)
        numbers = np.arange(1, len(mesh.elements) + 1)[:, None]
        rows = np.hstack((numbers, mesh.elements + 1))
        for solid, label in zip(solids, labels):
            own = mesh.solid_ids == solid
            write_elements(file, SOLID_ELEMENT[mesh.order], label, rows[own])
        face_labels = labels[len(solids) :]
        for label, (_, members) in zip(face_labels, faces):
            write_set(file, f"*NSET, NSET={label}", np.unique(surface.elements[members]) + 1)
        for label, nodes in nodes_of_edges(surface, labels):
            write_set(file, f"*NSET, NSET={label}", nodes)
        for label, (_, members) in zip(face_labels, faces):
            file.write(f"*SURFACE, NAME={label}, TYPE=ELEMENT\n")
            sides = mesh.face_sides[members]
            file.writelines(f"{t + 1}, S{side + 1}\n" for t, side in sides.tolist())


def _write_su2(mesh: VolumeMesh, path: Path) -> None:
    faces = list(_faces_by_name(mesh))
    labels = unique_labels([name for name, _ in faces], NAME)
    points, tetrahedra, triangles = _corners(mesh)
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write(f"% tetrahedra of surfmesh\nNDIME= 3\nNELEM= {len(tetrahedra)}\n")
        write_rows(file, f"{TETRAHEDRON} %d %d %d %d %d\n", _numbered(tetrahedra))
        file.write(f"NPOIN= {len(points)}\n")
        write_rows(file, "%.17g %.17g %.17g %d\n", _numbered(points))
        file.write(f"NMARK= {len(faces)}\n")
        for label, (_, members) in zip(labels, faces):
            file.write(f"MARKER_TAG= {label}\nMARKER_ELEMS= {len(members)}\n")
            write_rows(file, f"{TRIANGLE} %d %d %d\n", triangles[members])


def _write_medit(mesh: VolumeMesh, path: Path) -> None:
    points, tetrahedra, triangles = _corners(mesh)
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("MeshVersionFormatted 2\n\nDimension 3\n")
        for name, row, rows in (
            ("Vertices", "%.17g %.17g %.17g 0\n", points),
            ("Triangles", "%d %d %d %d\n",
             np.column_stack((triangles, mesh.surface.face_ids)) + 1),
            ("Tetrahedra", "%d %d %d %d %d\n", np.column_stack((tetrahedra, mesh.solid_ids)) + 1),
        ):  # fmt: skip
            file.write(f"\n{name}\n{len(rows)}\n")
            write_rows(file, row, rows)
        file.write("\nEnd\n")


def _faces_by_name(mesh: VolumeMesh) -> Iterator[tuple[str, NDArray]]:
    """Names of faces and the rows of their triangles."""
    surface = mesh.surface
    names = numbers_by_label(np.unique(surface.face_ids).tolist(), surface.groups.face_label)
    for name, faces in names.items():
        yield name, np.flatnonzero(np.isin(surface.face_ids, faces))


def _corners(mesh: VolumeMesh) -> tuple[NDArray, NDArray, NDArray]:
    """Points, tetrahedra and triangles of the surface without middles of edges."""
    if mesh.order == 1:
        return mesh.nodes, mesh.tetrahedra, mesh.surface.triangles
    used, inverse = np.unique(mesh.tetrahedra, return_inverse=True)
    # every vertex of the surface is a corner, and they come first
    return mesh.nodes[used], inverse.reshape(-1, 4), mesh.surface.triangles


def _numbered(rows: NDArray) -> NDArray:
    return np.column_stack((rows, np.arange(len(rows))))


_WRITERS: dict[str, Callable[[VolumeMesh, Path], None]] = {
    ".vtu": _write_vtu, ".msh": _write_msh, ".inp": _write_inp, ".su2": _write_su2,
    ".mesh": _write_medit,
}  # fmt: skip
