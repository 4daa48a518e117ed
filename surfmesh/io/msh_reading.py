"""Reading Gmsh's MSH 4.1, binary: what ``msh`` writes, and what Gmsh makes of it."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.group_record import group_fields
from surfmesh.io.numbers_of_groups import DENSE, named_faces
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.quadratic_triangles import split_six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

ATTRIBUTE = "surfmesh"  # the section of names, colours and the like
POINT = 15
NODES = {POINT: 1, 1: 2, 8: 3, 2: 3, 9: 6}  # of gmsh's element types that may be there
TRIANGLES = (2, 9)
LINES = (1, 8)


def read(path: Path) -> SurfaceMesh:
    """Triangles of three or six nodes; lines become segments of edges, points vertices of CAD."""
    content = _Content(path, path.read_bytes())
    version = content.section("MeshFormat").split(b"\n")[0].split()
    if version[:3] != [b"4.1", b"1", b"8"]:
        found = b" ".join(version).decode(errors="replace")
        raise FileFormatError(f"{path}: only binary MSH 4.1 is read, this is '{found}'")
    tags, points = content.nodes()
    order = np.argsort(tags)
    tags, points = tags[order], points[order]
    blocks = content.blocks()
    kinds = {kind for kind, _, _ in blocks} & set(TRIANGLES)
    if len(kinds) > 1:
        raise FileFormatError(f"{path}: holds triangles of three and of six nodes")
    width = NODES[kinds.pop()] if kinds else 3
    rows, face_ids = _gathered(blocks, TRIANGLES, width)
    by_tag = np.argsort(rows[:, 0], kind="stable")
    elements, face_ids = content.places(rows[by_tag, 1:], tags), face_ids[by_tag]
    fields: dict[str, Any] = {}
    kept = np.arange(len(tags))
    if width == 6:
        points, elements, fields["mid_points"], kept = split_six_nodes(points, elements)
    rank = np.full(len(tags), -1)
    rank[kept] = np.arange(len(kept))
    lines, numbers = _gathered(blocks, LINES, 2)
    if len(lines):
        segments = rank[content.places(lines[:, 1:], tags)]
        fields |= {"edge_segments": segments, "edge_ids": numbers}
    if content.vertices:
        fields["vertex_ids"] = content.vertices_of_model(rank, tags)
    sizes = content.point_values("size", tags)
    sizes = None if sizes is None else sizes[kept]
    fields |= group_fields(content.lines(ATTRIBUTE), len(elements), face_ids)
    if "groups" not in fields:
        names, count = content.face_names(), int(face_ids.max(initial=-1)) + 1
        face_ids, face_names, fields["warnings"] = named_faces(face_ids, names, count)
        fields["groups"] = MeshGroups(face_names=face_names)
    return SurfaceMesh(
        points=points, triangles=elements, face_ids=face_ids, sizes=sizes, **fields
    )  # fmt: skip


Block = tuple[int, int, NDArray]  # kind of element, number of the entity, rows of tags


def _gathered(blocks: list[Block], kinds: tuple, width: int) -> tuple[NDArray, NDArray]:
    """Rows (k, 1 + width) of element and node tags, and the numbers (k,) of their entities."""
    rows = [np.empty((0, 1 + width), np.int64)]
    rows += [row[:, : 1 + width] for kind, _, row in blocks if kind in kinds]
    numbers = [np.full(len(row), entity) for kind, entity, row in blocks if kind in kinds]
    return np.concatenate(rows), np.concatenate([np.empty(0, np.int64), *numbers])


class _Content:
    """The sections of one file, read in place."""

    def __init__(self, path: Path, data: bytes) -> None:
        self.path, self.data = path, data
        self.vertices: dict[int, int] = {}  # node tags by the numbers of point entities
        # not needed, but a sign of a file cut short
        for name in (ATTRIBUTE, "NodeData", "ElementData"):
            if data.count(f"${name}\n".encode()) != data.count(f"$End{name}".encode()):
                raise FileFormatError(f"{path}: the section ${name} does not end")
        _, _, rest = data[data.rfind(b"$End") :].partition(b"\n")
        if rest.lstrip().startswith(b"$"):
            raise FileFormatError(f"{path}: ends amid a section: it is cut")

    def section(self, name: str) -> bytes:
        start = self.data.find(f"${name}\n".encode())
        end = self.data.find(f"$End{name}".encode(), start)
        if start < 0 or end < 0:
            raise FileFormatError(f"{self.path}: the section ${name} is missing")
        return self.data[start + len(name) + 2 : end]

    def lines(self, name: str) -> list[str]:
        """The lines of a section that may be missing."""
        there = f"${name}\n".encode() in self.data
        return self.section(name).decode(errors="replace").splitlines() if there else []

    def nodes(self) -> tuple[NDArray, NDArray]:
        stream = _Stream(self.section("Nodes"))
        blocks = int(stream.take("<u8", 4)[0])
        tags, points = [np.empty(0, np.int64)], [np.empty((0, 3))]
        for _ in range(blocks):
            dimension, entity, parametric = map(int, stream.take("<i4", 3))
            count = int(stream.take("<u8", 1)[0])
            tags.append(stream.take("<u8", count).astype(np.int64))
            if dimension == 0 and count:
                self.vertices[entity - 1] = int(tags[-1][0])
            width = 3 + (dimension if parametric else 0)
            points.append(stream.take("<f8", width * count).reshape(-1, width)[:, :3])
        return np.concatenate(tags), np.concatenate(points)

    def blocks(self) -> list[Block]:
        stream = _Stream(self.section("Elements"))
        found = []
        for _ in range(int(stream.take("<u8", 4)[0])):
            _, entity, kind = map(int, stream.take("<i4", 3))
            count = int(stream.take("<u8", 1)[0])
            if kind not in NODES:
                raise FileFormatError(f"{self.path}: holds elements that are not triangles")
            row = stream.take("<u8", count * (1 + NODES[kind])).reshape(count, -1)
            found.append((kind, entity - 1, row.astype(np.int64)))
        return found

    def places(self, wanted: NDArray, tags: NDArray) -> NDArray:
        """Where node tags stand among the sorted ``tags``."""
        found = np.minimum(np.searchsorted(tags, wanted), max(len(tags) - 1, 0))
        if not len(tags) or (tags[found] != wanted).any():
            raise FileFormatError(f"{self.path}: an element has a corner that is no node")
        return found

    def vertices_of_model(self, rank: NDArray, tags: NDArray) -> NDArray:
        """The vertex at each point entity, -1 where there is none; rank: of nodes as vertices."""
        numbers = sorted(self.vertices)
        if numbers[0] < 0 or numbers[-1] >= DENSE:  # no table by numbers that are far apart
            places = {number: place for place, number in enumerate(numbers)}
        else:
            places = {number: number for number in numbers}
        found = np.full(max(places.values()) + 1, -1)
        for number, tag in self.vertices.items():
            found[places[number]] = rank[np.searchsorted(tags, tag)]
        return found

    def face_names(self) -> dict[int, str]:
        """Names of a file by another program: physical groups of surfaces with the face's tag."""
        physical = self._physical_of_surfaces()
        names = {}
        for line in self.lines("PhysicalNames")[1:]:
            dimension, tag, name = line.split(maxsplit=2)
            if dimension == "2":
                names[int(tag)] = name.strip().strip('"')
        return {face: names.get(group, "") for face, group in physical.items()}

    def _physical_of_surfaces(self) -> dict[int, int]:
        if b"$Entities\n" not in self.data:
            return {}
        stream = _Stream(self.section("Entities"))
        counts = stream.take("<u8", 4).tolist()
        found = {}
        for dimension, count in enumerate(counts[:3]):
            for _ in range(count):
                number = int(stream.take("<i4", 1)[0]) - 1
                stream.take("<f8", 6 if dimension else 3)
                groups = stream.take("<i4", int(stream.take("<u8", 1)[0]))
                if dimension:
                    stream.take("<i4", int(stream.take("<u8", 1)[0]))
                if dimension == 2 and len(groups):
                    found[number] = abs(int(groups[0]))
        return found

    def point_values(self, name: str, tags: NDArray) -> NDArray | None:
        """Node data ``name`` in the order of the sorted ``tags``, when every node has it."""
        head = f'$NodeData\n1\n"{name}"\n1\n0\n3\n0\n1\n{len(tags)}\n'.encode()
        start = self.data.find(head)
        if start < 0:
            return None
        record = np.dtype([("tag", "<i4"), ("value", "<f8")])
        found = np.frombuffer(self.data, record, len(tags), start + len(head))
        found = found[np.argsort(found["tag"])]
        return found["value"] if (found["tag"] == tags).all() else None


class _Stream:
    """Numbers one after the other."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def take(self, kind: str, count: int) -> NDArray:
        found = np.frombuffer(self.data, kind, count, self.at)
        self.at += found.nbytes
        return found
