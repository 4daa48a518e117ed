"""Abaqus and CalculiX input: shells S3, STRI65 or S6, sets for each face, solid and edge.

Each name of a face is a set of elements, a set of nodes and a surface (the side to which the
normals point); a solid is a set of elements, an edge one of nodes. Names become letters, digits
and '_'; what they were, colours, kinds and the unit stand in comments at the end. Coordinates have
20 characters, which is what both read.
Format: Abaqus Keywords Reference, *NODE, *ELEMENT, *ELSET, *NSET, *SURFACE; CalculiX CrunchiX
manual.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.group_record import (
    MARK,
    group_fields,
    group_lines,
    numbers_by_label,
    require_last_line,
    unique_labels,
)
from surfmesh.io.text_columns import numbers, shortest
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.quadratic_triangles import split_six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

COORDINATE = 20  # characters
NAME = 60  # characters; both allow 80
THREE_NODES = ("S3", "S3R", "STRI3", "S3RS", "CPS3", "CPE3", "M3D3", "DS3", "R3D3")
SIX_NODES = ("STRI65", "S6", "CPS6", "CPE6", "M3D6", "DS6")
LINES = ("T3D2", "T3D3", "B21", "B22", "B31", "B32", "B33")  # passed over, as Gmsh writes them
KIND = {"abaqus": {1: "S3", 2: "STRI65"}, "calculix": {1: "S3", 2: "S6"}}
OURS = "** surfmesh"  # the first line; the last ones are the record of groups then


def write(mesh: SurfaceMesh, path: Path, target: str = "abaqus") -> None:
    groups, kind = mesh.groups, KIND[target][mesh.order]
    faces = np.unique(mesh.face_ids).tolist()
    sides = np.empty((0, 2), np.int32) if mesh.solid_ids is None else mesh.solid_ids
    solids = np.unique(sides[sides >= 0]).tolist()
    face_labels = list(dict.fromkeys(map(groups.face_label, faces)))
    labels = unique_labels([*face_labels, *map(groups.solid_label, solids)], NAME)
    named = dict(zip(face_labels, labels))
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write(f"{OURS}{', unit ' + groups.unit if groups.unit else ''}\n")
        write_nodes(file, mesh.nodes)
        elements = np.column_stack((np.arange(len(mesh.triangles)), mesh.elements)) + 1
        order = np.argsort(mesh.face_ids, kind="stable")
        members = np.split(order, np.searchsorted(mesh.face_ids[order], faces[1:]))
        on_faces: dict[str, list[NDArray]] = {}
        for face, own in zip(faces, members):
            label = named[groups.face_label(face)]
            write_elements(file, kind, label, elements[own])
            on_faces.setdefault(label, []).append(elements[own, 1:].reshape(-1))
        for solid, label in zip(solids, labels[len(face_labels) :]):
            own = np.flatnonzero((sides == solid).any(axis=1))
            write_set(file, f"*ELSET, ELSET={label}", own + 1)
        for label, nodes in on_faces.items():
            write_set(file, f"*NSET, NSET={label}", np.unique(np.concatenate(nodes)))
        for label, nodes_of_edge in nodes_of_edges(mesh, list(on_faces)):
            write_set(file, f"*NSET, NSET={label}", nodes_of_edge)
        for label in on_faces:
            file.write(f"*SURFACE, NAME={label}, TYPE=ELEMENT\n{label}, SPOS\n")
        file.writelines(f"** {line}\n" for line in group_lines(mesh, numbered=True))


def write_nodes(file: TextIO, nodes: NDArray) -> None:
    """Nodes (n, 3), counted from 1."""
    file.write("*NODE, NSET=ALL_NODES\n")
    words = iter(shortest(nodes.ravel().tolist(), COORDINATE))
    rows = enumerate(zip(words, words, words), 1)
    file.writelines(f"{n}, {x}, {y}, {z}\n" for n, (x, y, z) in rows)


def write_elements(file: TextIO, kind: str, label: str, rows: NDArray) -> None:
    """Elements (k, 1 + nodes), the number first, of one kind, in the set ``label``."""
    file.write(f"*ELEMENT, TYPE={kind}, ELSET={label}\n")
    file.writelines(f"{', '.join(map(str, row))}\n" for row in rows.tolist())


def write_set(file: TextIO, head: str, found: NDArray) -> None:
    """Numbers under the line ``head``, eight a line: meshio takes GENERATE for one range only."""
    file.write(f"{head}\n")
    rows = found.tolist()
    for at in range(0, len(rows), 8):
        file.write(", ".join(map(str, rows[at : at + 8])) + "\n")


def nodes_of_edges(mesh: SurfaceMesh, taken: list[str]) -> Iterator[tuple[str, NDArray]]:
    """Names and the tags of the nodes on CAD edges, edges of one name together.

    taken: names of sets of nodes that there are already.
    """
    if mesh.edge_ids is None:
        return
    labels = numbers_by_label(np.unique(mesh.edge_ids).tolist(), mesh.groups.edge_label)
    names = unique_labels([*taken, *labels], NAME)[len(taken) :]
    for name, edges in zip(names, labels.values()):
        own = mesh.edge_elements[np.isin(mesh.edge_ids, edges)]
        yield name, np.unique(own) + 1


def read(path: Path) -> SurfaceMesh:
    """Nodes and shells of three or of six nodes; everything else is passed over."""
    with open(path, encoding="utf-8", errors="replace") as file:
        ours = file.readline().startswith(OURS)
        file.seek(0)
        record, blocks = _blocks(file)
    tags, points = [np.empty(0, np.int64)], [np.empty((0, 3))]
    rows: list[NDArray] = []
    names: dict[str, int] = {}
    face_ids: list[NDArray] = []
    for keyword, options, lines in blocks:
        if keyword == "NODE":
            found = numbers(lines, 4)
            tags.append(found[:, 0].astype(np.int64))
            points.append(found[:, 1:])
        elif keyword == "ELEMENT":
            kind = options.get("TYPE", "").upper()
            if kind in LINES:
                continue
            if kind not in THREE_NODES + SIX_NODES:
                raise FileFormatError(f"{path}: holds elements {kind} that are not triangles")
            rows.append(numbers(lines, 7 if kind in SIX_NODES else 4, int))
            face = names.setdefault(options.get("ELSET", ""), len(names))
            face_ids.append(np.full(len(lines), face))
    if not rows:
        raise FileFormatError(f"{path}: there are no triangles in it")
    if len({row.shape[1] for row in rows}) > 1:
        raise FileFormatError(f"{path}: holds triangles of three and of six nodes")
    table = np.concatenate(rows)
    by_tag = np.argsort(table[:, 0], kind="stable")
    nodes, elements = placed(path, np.concatenate(tags), np.concatenate(points), table[by_tag, 1:])
    fields = group_fields(record, len(table))
    if fields:
        require_last_line(path)
    elif ours:
        raise FileFormatError(f"{path}: is cut: its last comments, the record of groups, are gone")
    fields.setdefault("face_ids", np.concatenate(face_ids)[by_tag])
    fields.setdefault("groups", MeshGroups(face_names=tuple(names)))
    if elements.shape[1] == 6:
        nodes, elements, fields["mid_points"], _ = split_six_nodes(nodes, elements)
    return SurfaceMesh(points=nodes, triangles=elements, **fields)


def placed(
    path: Path, tags: NDArray, points: NDArray, rows: NDArray
) -> tuple[NDArray, NDArray]:  # fmt: skip
    """Points in the order of their tags, and elements by index instead of tag."""
    order = np.argsort(tags)
    tags = tags[order]
    found = np.minimum(np.searchsorted(tags, rows), max(len(tags) - 1, 0))
    if not len(tags) or (tags[found] != rows).any():
        raise FileFormatError(f"{path}: an element has a corner that is no node")
    return points[order], found


Block = tuple[str, dict[str, str], list[str]]  # keyword, its options, the lines below


def _blocks(file: TextIO) -> tuple[list[str], list[Block]]:
    """Lines of the record, and what stands under each keyword."""
    record: list[str] = []
    blocks: list[Block] = []
    for line in file:
        if line.startswith("**"):
            if MARK in line:
                record.append(line)
        elif line.startswith("*"):
            keyword, *words = (word.strip() for word in line[1:].split(","))
            options = dict(_option(word) for word in words)
            blocks.append((keyword.upper(), options, []))
        elif line.strip() and blocks:
            blocks[-1][2].append(line)
    return record, blocks


def _option(word: str) -> tuple[str, str]:
    name, _, value = word.partition("=")
    return name.strip().upper(), value.strip().strip('"')
