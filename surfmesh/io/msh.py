"""Gmsh's MSH 4.1, binary: one surface entity and one physical group for each face.

Format: Gmsh reference manual, section "MSH file format", version 4.1.
"""

from pathlib import Path
from typing import BinaryIO

import numpy as np

from surfmesh.errors import FileFormatError
from surfmesh.quality.shape import alpha
from surfmesh.surface_mesh import SurfaceMesh

SURFACE_DIMENSION, TRIANGLE = 2, 2  # of an entity; gmsh's number of the 3-node triangle


def write(mesh: SurfaceMesh, path: Path) -> None:
    """Node and element tags are index + 1, entity and physical tags are face_id + 1."""
    order = np.argsort(mesh.face_ids, kind="stable")
    faces, starts = np.unique(mesh.face_ids[order], return_index=True)
    members = np.split(order, starts[1:])
    owner = np.zeros(len(mesh.points), np.int32)  # a vertex belongs to one face, the first
    for face, triangles in zip(faces[::-1], members[::-1]):
        owner[mesh.triangles[triangles]] = face
    with open(path, "wb") as file:
        _section(file, "MeshFormat", b"4.1 1 8\n" + _ints(1) + b"\n")
        names = [f'2 {face + 1} "{_quoted(mesh.face_name(int(face)))}"' for face in faces]
        _section(file, "PhysicalNames", "\n".join([str(len(names)), *names, ""]).encode())

        file.write(b"$Entities\n" + _sizes(0, 0, len(faces), 0))
        for face, triangles in zip(faces, members):
            corners = mesh.points[mesh.triangles[triangles].reshape(-1)]
            box = np.concatenate((corners.min(axis=0), corners.max(axis=0)))
            file.write(_ints(face + 1) + box.tobytes() + _sizes(1) + _ints(face + 1) + _sizes(0))
        file.write(b"\n$EndEntities\n")

        file.write(b"$Nodes\n" + _sizes(len(faces), len(owner), 1, len(owner)))
        for face in faces:
            vertices = np.flatnonzero(owner == face)
            file.write(_ints(SURFACE_DIMENSION, face + 1, 0) + _sizes(len(vertices)))
            file.write((vertices + 1).astype("<u8").tobytes())
            file.write(mesh.points[vertices].astype("<f8").tobytes())
        file.write(b"\n$EndNodes\n")

        count = len(mesh.triangles)
        file.write(b"$Elements\n" + _sizes(len(faces), count, 1, count))
        for face, triangles in zip(faces, members):
            file.write(_ints(SURFACE_DIMENSION, face + 1, TRIANGLE) + _sizes(len(triangles)))
            rows = np.column_stack((triangles, mesh.triangles[triangles])) + 1
            file.write(rows.astype("<u8").tobytes())
        file.write(b"\n$EndElements\n")

        if mesh.sizes is not None:
            _section(file, "NodeData", _values("size", mesh.sizes))
        _section(file, "ElementData", _values("alpha", alpha(mesh)))


def read(path: Path) -> SurfaceMesh:
    """Binary MSH 4.1 with triangles; lines and points are passed over."""
    content = _Content(path, path.read_bytes())
    version = content.section("MeshFormat").split(b"\n")[0].split()
    if version[:3] != [b"4.1", b"1", b"8"]:
        found = b" ".join(version).decode(errors="replace")
        raise FileFormatError(f"{path}: only binary MSH 4.1 is read, this is '{found}'")
    tags, points = content.nodes()
    rows, face_ids, element_tags = content.triangles()
    order = np.argsort(tags)
    tags = tags[order]
    triangles = np.minimum(np.searchsorted(tags, rows), max(len(tags) - 1, 0))
    if not len(tags) or (tags[triangles] != rows).any():
        raise FileFormatError(f"{path}: a triangle has a corner that is no node")
    by_tag = np.argsort(element_tags, kind="stable")
    return SurfaceMesh(
        points=points[order],
        triangles=triangles[by_tag],
        face_ids=face_ids[by_tag],
        sizes=content.point_values("size", tags),
    )


class _Content:
    """The sections of one file, read in place."""

    def __init__(self, path: Path, data: bytes) -> None:
        self.path, self.data = path, data
        for name in ("NodeData", "ElementData"):  # not needed, but a sign of a file cut short
            if data.count(f"${name}\n".encode()) != data.count(f"$End{name}".encode()):
                raise FileFormatError(f"{path}: the section ${name} does not end")

    def section(self, name: str) -> bytes:
        start = self.data.find(f"${name}\n".encode())
        end = self.data.find(f"$End{name}".encode(), start)
        if start < 0 or end < 0:
            raise FileFormatError(f"{self.path}: the section ${name} is missing")
        return self.data[start + len(name) + 2 : end]

    def nodes(self) -> tuple[np.ndarray, np.ndarray]:
        stream = _Stream(self.section("Nodes"))
        blocks = int(stream.take("<u8", 4)[0])
        tags, points = [np.empty(0, np.int64)], [np.empty((0, 3))]
        for _ in range(blocks):
            dimension, _, parametric = stream.take("<i4", 3)
            count = int(stream.take("<u8", 1)[0])
            tags.append(stream.take("<u8", count).astype(np.int64))
            width = 3 + (int(dimension) if parametric else 0)
            points.append(stream.take("<f8", width * count).reshape(-1, width)[:, :3])
        return np.concatenate(tags), np.concatenate(points)

    def triangles(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        stream = _Stream(self.section("Elements"))
        corners = {15: 1, 1: 2, TRIANGLE: 3}  # point, line, triangle
        blocks = int(stream.take("<u8", 4)[0])
        rows, faces = [np.empty((0, 4), np.int64)], [np.empty(0, np.int32)]
        for _ in range(blocks):
            _, entity, kind = map(int, stream.take("<i4", 3))
            count = int(stream.take("<u8", 1)[0])
            if kind not in corners:
                raise FileFormatError(f"{self.path}: holds elements that are not triangles")
            row = stream.take("<u8", count * (1 + corners[kind])).reshape(count, -1)
            if kind == TRIANGLE:
                rows.append(row.astype(np.int64))
                faces.append(np.full(count, entity - 1, np.int32))
        found = np.concatenate(rows)
        return found[:, 1:], np.concatenate(faces), found[:, 0]

    def point_values(self, name: str, tags: np.ndarray) -> np.ndarray | None:
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

    def take(self, kind: str, count: int) -> np.ndarray:
        found = np.frombuffer(self.data, kind, count, self.at)
        self.at += found.nbytes
        return found


def _section(file: BinaryIO, name: str, body: bytes) -> None:
    file.write(f"${name}\n".encode() + body + f"$End{name}\n".encode())


def _values(name: str, values: np.ndarray) -> bytes:
    """A scalar field at time 0, step 0, for tags 1, 2, ..."""
    records = np.empty(len(values), [("tag", "<i4"), ("value", "<f8")])
    records["tag"], records["value"] = np.arange(1, len(values) + 1), values
    return f'1\n"{name}"\n1\n0\n3\n0\n1\n{len(values)}\n'.encode() + records.tobytes() + b"\n"


def _quoted(name: str) -> str:
    return "".join("_" if mark in '"\n\r' else mark for mark in name)[:127]


def _ints(*values: int) -> bytes:
    return np.array(values, "<i4").tobytes()


def _sizes(*values: int) -> bytes:
    return np.array(values, "<u8").tobytes()
