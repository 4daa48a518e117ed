"""Gmsh's MSH 4.1, binary: entities by number, physical groups by name.

Format: Gmsh reference manual, section "MSH file format", version 4.1.

tags          nodes and elements are counted from 1 in the order of the mesh, triangles first;
              entities are number + 1 of the vertex, edge, face or solid
surfaces      one entity a face; one physical group a name, so that each element is in one
curves        one entity a CAD edge, its segments as lines; physical groups in the same way
points        one entity a CAD vertex, which says whose its node is; without elements, since
              meshio takes groups for all blocks of elements or for none
volumes       one entity a solid, bounded by its faces, without elements. Their names are in
              $PhysicalNames, but no entity is in such a group: dolfinx before 0.10 refuses
              groups without elements
$surfmesh     colours, kinds, unit; Gmsh reads and writes it as an attribute of the model
"""

from collections.abc import Mapping
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.io.group_record import group_lines, solids_of_faces
from surfmesh.io.msh_reading import ATTRIBUTE, read
from surfmesh.quality.measures.shape import alpha
from surfmesh.result.quadratic_triangles import edge_rows
from surfmesh.result.surface_mesh import SurfaceMesh

__all__ = ["read", "write"]

LINE, TRIANGLE = {1: 1, 2: 8}, {1: 2, 2: 9}  # gmsh's numbers of element types, by order
TETRAHEDRON = {1: 4, 2: 11}


class _Entity(NamedTuple):
    """Of dimension 0 to 3: its elements, rows of nodes."""

    dimension: int
    number: int
    kind: int  # of element
    elements: NDArray  # (k, corners)
    tags: NDArray  # (k,) from 1
    group: int  # physical; 0: none
    bounds: NDArray  # tags of the entities around it; of faces that look inwards with a minus


def write(mesh: SurfaceMesh, path: Path, volumes: bool = True) -> None:
    """volumes: with entities for solids, which Gmsh leaves empty whatever it is asked."""
    solids = _volumes(mesh) if volumes else []
    with open(path, "wb") as file:
        used = _write_model(file, mesh, mesh.nodes, solids)
        if mesh.node_sizes is not None:
            _section(file, "NodeData", _values("size", mesh.node_sizes))
        # meshio wants a value for every element, in the order of the tags: lines get a 1
        shape = np.concatenate((alpha(mesh), np.ones(used - len(mesh.triangles))))
        _section(file, "ElementData", _values("alpha", shape))


def write_filled(
    mesh: SurfaceMesh, nodes: NDArray, filled: Mapping[int, NDArray], path: Path
) -> None:
    """A surface and the tetrahedra (k, 4 or 10) in its solids, by the numbers of these.

    nodes: those of the surface first. Middles of edges are in the order of VTK.
    """
    with open(path, "wb") as file:
        order = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]  # gmsh's, of the columns of VTK
        solids = []
        for entity in _volumes(mesh):
            rows = filled.get(entity.number, np.empty((0, 4), int))
            kind = TETRAHEDRON[1 if rows.shape[1] == 4 else 2]
            rows = rows[:, order[: rows.shape[1]]]
            solids.append(entity._replace(elements=rows, kind=kind, group=entity.number + 1))
        _write_model(file, mesh, nodes, solids)


def _write_model(file: BinaryIO, mesh: SurfaceMesh, nodes: NDArray, solids: list[_Entity]) -> int:
    """All but values at nodes and elements. Returns the number of elements."""
    edge_groups, face_groups, names = _groups(mesh, [solid.number for solid in solids])
    entities = [*_vertices(mesh), *_curves(mesh, edge_groups), *_surfaces(mesh, face_groups)]
    entities += solids
    used = len(mesh.triangles)
    for at, entity in enumerate(entities):
        if entity.dimension in (1, 3):
            tags = used + 1 + np.arange(len(entity.elements))
            entities[at] = entity._replace(tags=tags)
            used += len(entity.elements)
    _section(file, "MeshFormat", b"4.1 1 8\n" + _ints(1) + b"\n")
    _section(file, "PhysicalNames", "\n".join([str(len(names)), *names, ""]).encode())
    file.write(b"$Entities\n")
    file.write(_sizes(*(sum(entity.dimension == d for entity in entities) for d in range(4))))
    for entity in entities:
        file.write(_described(entity, nodes))
    file.write(b"\n$EndEntities\n")
    _write_nodes(file, nodes, entities)
    # triangles first, as meshio takes values by this order; no block without elements
    blocks = [entity for d in (2, 1, 3) for entity in entities if entity.dimension == d]
    blocks = [entity for entity in blocks if len(entity.elements)]
    file.write(b"$Elements\n" + _sizes(len(blocks), used, 1, used))
    for entity in blocks:
        file.write(_ints(entity.dimension, entity.number + 1, entity.kind))
        file.write(_sizes(len(entity.elements)))
        rows = np.column_stack((entity.tags, entity.elements + 1))
        file.write(rows.astype("<u8").tobytes())
    file.write(b"\n$EndElements\n")
    _section(file, ATTRIBUTE, "\n".join([*group_lines(mesh), ""]).encode())
    return used


def _write_nodes(file: BinaryIO, nodes: NDArray, entities: list[_Entity]) -> None:
    """A node belongs to one entity, the first that has it."""
    with_nodes = [entity for entity in entities if len(entity.elements)]
    file.write(b"$Nodes\n" + _sizes(len(with_nodes), len(nodes), 1, len(nodes)))
    free = np.ones(len(nodes), bool)
    for entity in with_nodes:
        own = np.unique(entity.elements)
        own = own[free[own]]
        free[own] = False
        file.write(_ints(entity.dimension, entity.number + 1, 0) + _sizes(len(own)))
        file.write((own + 1).astype("<u8").tobytes() + nodes[own].astype("<f8").tobytes())
    file.write(b"\n$EndNodes\n")


def _groups(
    mesh: SurfaceMesh, solids: list[int]
) -> tuple[dict[int, int], dict[int, int], list[str]]:  # fmt: skip
    """Physical tags of edges and faces by their numbers, and the lines of $PhysicalNames.

    The tag of a name is the first number that has it, plus one.
    """
    groups, lines, found = mesh.groups, [], []
    edges = [] if mesh.edge_ids is None else np.unique(mesh.edge_ids).tolist()
    faces = np.unique(mesh.face_ids).tolist()
    face_labels = {groups.face_label(face) for face in faces}
    for dimension, numbers, label in ((1, edges, groups.edge_label), (2, faces, groups.face_label)):
        tags: dict[str, int] = {}
        table = {}
        for number in numbers:
            name = label(number)
            if dimension == 1 and name in face_labels:
                name += " (edge)"  # some readers know groups by their name alone
            if name not in tags:
                tags[name] = number + 1
                lines.append(f'{dimension} {number + 1} "{_quoted(name)}"')
            table[number] = tags[name]
        found.append(table)
    for number, name in names_of_solids(mesh, solids):
        lines.append(f'3 {number + 1} "{_quoted(name)}"')
    return found[0], found[1], lines


def names_of_solids(mesh: SurfaceMesh, solids: list[int]) -> list[tuple[int, str]]:
    """Solids and their names, with the number where several have one: Gmsh wants each but once."""
    labels = [mesh.groups.solid_label(number) for number in solids]
    return [
        (number, f"{called} {number}" if labels.count(called) > 1 else called)
        for number, called in zip(solids, labels)
    ]


def _vertices(mesh: SurfaceMesh) -> list[_Entity]:
    if mesh.vertex_ids is None:
        return []
    none = np.empty(0, int)
    return [
        _Entity(0, number, 0, np.array([[vertex]]), none, 0, none)
        for number, vertex in enumerate(mesh.vertex_ids.tolist())
        if vertex >= 0
    ]


def _curves(mesh: SurfaceMesh, groups: dict[int, int]) -> list[_Entity]:
    if mesh.edge_ids is None:
        return []
    elements, none = mesh.edge_elements, np.empty(0, int)
    return [
        _Entity(1, edge, LINE[mesh.order], elements[members], none, groups[edge], none)
        for edge, members in _members(mesh.edge_ids)
    ]


def _surfaces(mesh: SurfaceMesh, groups: dict[int, int]) -> list[_Entity]:
    around = _edges_of_faces(mesh)
    elements, kind = mesh.elements, TRIANGLE[mesh.order]
    return [
        _Entity(2, face, kind, elements[members], members + 1, groups[face],
                around.get(face, np.empty(0, int)) + 1)
        for face, members in _members(mesh.face_ids)
    ]  # fmt: skip


def _edges_of_faces(mesh: SurfaceMesh) -> dict[int, NDArray]:
    """Numbers of the CAD edges along which each face has triangles."""
    links = mesh.edge_links
    if links is None or not len(links.edge_segments):
        return {}
    rows = np.full(len(mesh.edges), -1)
    at = edge_rows(mesh.connectivity, links.edge_segments)
    rows[at[at >= 0]] = links.edge_ids[at >= 0]
    pairs = np.stack((mesh.triangles, mesh.triangles[:, (1, 2, 0)]), axis=-1).reshape(-1, 2)
    edges = rows[edge_rows(mesh.connectivity, pairs)]
    used = np.column_stack((np.repeat(mesh.face_ids, 3), edges))[edges >= 0]
    used = np.unique(used, axis=0)
    return {face: used[members, 1] for face, members in _members(used[:, 0])}


def _volumes(mesh: SurfaceMesh) -> list[_Entity]:
    """Solids, without elements."""
    behind, before = solids_of_faces(mesh).T
    none = np.empty(0, int)
    return [
        _Entity(3, solid, 0, np.empty((0, 4), int), none, 0,
                np.concatenate((np.flatnonzero(behind == solid) + 1,
                                -np.flatnonzero(before == solid) - 1)))
        for solid in np.unique((behind, before)).tolist()
        if solid >= 0
    ]  # fmt: skip


def _members(numbers: NDArray) -> list[tuple[int, NDArray]]:
    """Each number and where it stands."""
    order = np.argsort(numbers, kind="stable")
    found, starts = np.unique(numbers[order], return_index=True)
    return list(zip(found.tolist(), np.split(order, starts[1:])))


def _described(entity: _Entity, nodes: NDArray) -> bytes:
    """Its line in $Entities."""
    group = (entity.group,) if entity.group else ()
    text = _ints(entity.number + 1)
    if entity.dimension == 0:
        return text + nodes[entity.elements[0]].astype("<f8").tobytes() + _sizes(0)
    own = entity.elements.reshape(-1)
    text += _box(nodes[own] if len(own) else nodes) + _sizes(len(group)) + _ints(*group)
    return text + _sizes(len(entity.bounds)) + _ints(*entity.bounds)


def _box(points: NDArray) -> bytes:
    return np.concatenate((points.min(axis=0), points.max(axis=0))).astype("<f8").tobytes()


def _section(file: BinaryIO, name: str, body: bytes) -> None:
    file.write(f"${name}\n".encode() + body + f"$End{name}\n".encode())


def _values(name: str, values: NDArray) -> bytes:
    """A scalar field at time 0, step 0, for tags 1, 2, ..."""
    records = np.empty(len(values), [("tag", "<i4"), ("value", "<f8")])
    records["tag"], records["value"] = np.arange(1, len(values) + 1), values
    return f'1\n"{name}"\n1\n0\n3\n0\n1\n{len(values)}\n'.encode() + records.tobytes() + b"\n"


def _quoted(name: str) -> str:
    """What Gmsh and meshio read between quotes: the one ends sections at $End, the other takes a
    backslash for the start of an escape.
    """
    for mark, other in (('"', "_"), ("\\", "/"), ("$End", "_End")):
        name = name.replace(mark, other)
    return name[:127]


def _ints(*values: int) -> bytes:
    return np.array(values, "<i4").tobytes()


def _sizes(*values: int) -> bytes:
    return np.array(values, "<u8").tobytes()
