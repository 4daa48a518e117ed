"""Binary glTF 2.0: one node a solid, one primitive a face, colours as materials.

Single precision; vertices stand once a face, with their numbers beside. Faces, solids and all
else that surfmesh knows stand in "extras"; a face between two solids is in the nodes of both.
A root node scales to metres, which is glTF's unit, and moves what lies far from the origin back
there, so that single precision is spent on the mesh alone.
Format: Khronos glTF 2.0 specification, sections 3 and 4.
"""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.colours import colour_of, linear
from surfmesh.io.expansion import Expansion
from surfmesh.io.glb_bounds import require_bounded
from surfmesh.io.group_record import solids_of_faces
from surfmesh.io.to_trimesh import read_with_trimesh
from surfmesh.result.mesh_groups import METRES, MeshGroups
from surfmesh.result.surface_mesh import SurfaceMesh

FLOAT, UINT = 5126, 5125  # of accessors
VERTICES, INDICES = 34962, 34963  # targets of buffer views
EXTRAS = "surfmesh"


def write(mesh: SurfaceMesh, path: Path) -> None:
    groups = mesh.groups
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    far = np.linalg.norm(low + high) > 2.0 * np.linalg.norm(high - low)
    store = _Store(0.5 * (low + high) if far else np.zeros(3))
    solids_of = solids_of_faces(mesh)
    faces = np.unique(mesh.face_ids).tolist()
    solids = np.unique(solids_of[faces]).tolist()
    order = np.argsort(mesh.face_ids, kind="stable")
    members = np.split(order, np.searchsorted(mesh.face_ids[order], faces[1:]))
    pieces = {face: store.piece(mesh, own) for face, own in zip(faces, members)}
    nodes: list[dict[str, Any]] = []
    meshes: list[dict[str, Any]] = []
    for solid in solids:
        primitives = []
        for face in faces:
            behind, before = solids_of[face].tolist()
            if solid == -1 and (behind, before) != (-1, -1):
                continue
            if solid in (behind, before):
                primitive = store.primitive(pieces[face], turned=solid not in (behind, -1))
                colour = colour_of(mesh, face, solid)
                if colour is not None:
                    primitive["material"] = store.material(colour)
                label, kind = groups.face_label(face), groups.face_kind(face)
                numbers = primitive["attributes"]["POSITION"] + 1
                extras = {"face_id": face, "name": label, "kind": kind, "vertices": numbers}
                primitive["extras"] = extras
                primitives.append(primitive)
        if primitives:
            label = groups.solid_label(solid) if solid >= 0 else _loose_label(mesh)
            nodes.append({"name": label, "mesh": len(meshes), "extras": {"solid_id": solid}})
            meshes.append({"name": label, "primitives": primitives})
    root = {"name": "surfmesh", "children": list(range(1, len(nodes) + 1))}
    scale = METRES.get(groups.unit, 1.0)
    if scale != 1.0:
        root["scale"] = [scale] * 3
    if far:
        root["translation"] = (scale * store.origin).tolist()
    record = {"groups": groups.plain(), "points": len(mesh.points)}
    record["origin"] = store.origin.tolist()
    content = {
        "asset": {"version": "2.0", "generator": "surfmesh", "extras": {EXTRAS: record}},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [root, *nodes],
        "meshes": meshes,
        **store.content(),
    }
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    data = b"".join(store.chunks)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(data), b"BIN\0") + data)


def _loose_label(mesh: SurfaceMesh) -> str:
    return "surface" if mesh.solid_ids is None else "faces of no solid"


class _Store:
    """Buffer views, accessors and materials while they grow."""

    def __init__(self, origin: NDArray) -> None:
        self.origin = origin  # of the positions, in the mesh
        self.chunks: list[bytes] = []
        self.size = 0
        self.views: list[dict] = []
        self.accessors: list[dict] = []
        self.materials: dict[tuple, int] = {}

    def piece(self, mesh: SurfaceMesh, members: NDArray) -> tuple[int, NDArray]:
        """The vertices of a face, once: accessor of positions, and triangles of them."""
        used, corners = np.unique(mesh.triangles[members], return_inverse=True)
        positions = (mesh.points[used] - self.origin).astype("<f4")
        limits = {"min": positions.min(0).tolist(), "max": positions.max(0).tolist()}
        accessor = self._accessor(positions, FLOAT, "VEC3", VERTICES, limits)
        self._accessor(used.astype("<u4"), UINT, "SCALAR")  # the next one: see read
        return accessor, corners.reshape(-1, 3)

    def primitive(self, piece: tuple[int, NDArray], turned: bool) -> dict[str, Any]:
        positions, triangles = piece
        rows = triangles[:, ::-1] if turned else triangles
        indices = self._accessor(rows.astype("<u4").reshape(-1), UINT, "SCALAR", INDICES)
        return {"attributes": {"POSITION": positions}, "indices": indices, "mode": 4}

    def material(self, colour: tuple) -> int:
        return self.materials.setdefault(colour, len(self.materials))

    def content(self) -> dict[str, Any]:
        """Top-level entries of the JSON chunk; no list may be empty."""
        found = {
            "buffers": [{"byteLength": self.size}],
            "bufferViews": self.views,
            "accessors": self.accessors,
        }
        if self.materials:
            found["materials"] = [
                {
                    "pbrMetallicRoughness": {
                        "baseColorFactor": [*map(linear, colour), 1.0],
                        "metallicFactor": 0.0,
                        "roughnessFactor": 0.6,
                    },
                    "doubleSided": True,
                }
                for colour in self.materials
            ]
        return found

    def _accessor(
        self, values: NDArray, component: int, kind: str, target: int = 0,
        limits: dict[str, Any] | None = None,
    ) -> int:  # fmt: skip
        data = values.tobytes()
        view = {"buffer": 0, "byteOffset": self.size, "byteLength": len(data)}
        if target:
            view["target"] = target
        self.views.append(view)
        self.chunks.append(data)  # all of four bytes a number: always aligned
        self.size += len(data)
        self.accessors.append(
            {"bufferView": len(self.views) - 1, "componentType": component, "type": kind,
             "count": len(values), **(limits or {})}
        )  # fmt: skip
        return len(self.accessors) - 1


def read(path: Path) -> SurfaceMesh:
    """What ``write`` wrote in full; of other files the triangles, in metres."""
    data = path.read_bytes()
    if len(data) < 28 or struct.unpack_from("<4sII", data)[::2] != (b"glTF", len(data)):
        raise FileFormatError(f"{path}: not a whole binary glTF file")
    size = struct.unpack_from("<I", data, 12)[0]
    content = json.loads(data[20 : 20 + size])
    record = content["asset"].get("extras", {}).get(EXTRAS)
    if record is None:
        require_bounded(path, content, len(data))
        found = read_with_trimesh(path, data)
        return SurfaceMesh(points=found.vertices, triangles=found.faces)
    start = 20 + size + 8
    expansion = Expansion(path, len(data))

    def values(number: int) -> NDArray:
        accessor = content["accessors"][number]
        at = start + content["bufferViews"][accessor["bufferView"]]["byteOffset"]
        count = accessor["count"]
        if count < 0 or at < start:
            raise FileFormatError(f"{path}: accessor {number} is damaged")
        expansion.take(12 * count)  # many may show the same bytes
        if accessor["type"] == "VEC3":
            return np.frombuffer(data, "<f4", 3 * count, at).reshape(-1, 3)
        return np.frombuffer(data, "<u4", count, at)

    if not 0 <= record["points"] <= len(data) // 12:
        raise FileFormatError(f"{path}: is of {record['points']} vertices and cannot hold them")
    points = np.zeros((record["points"], 3))
    triangles: dict[int, NDArray] = {}
    solids: dict[int, list[int]] = {}
    for node in content["nodes"]:
        if "mesh" not in node:
            continue
        solid = node["extras"]["solid_id"]
        for primitive in content["meshes"][node["mesh"]]["primitives"]:
            face = primitive["extras"]["face_id"]
            if face in solids:
                solids[face][1] = solid  # the one before it
                continue
            solids[face] = [solid, -1]
            numbers = values(primitive["extras"]["vertices"])
            points[numbers] = values(primitive["attributes"]["POSITION"]) + record["origin"]
            triangles[face] = numbers[values(primitive["indices"])].reshape(-1, 3)
    faces = sorted(triangles)
    face_ids = np.repeat(faces, [len(triangles[face]) for face in faces])
    known = any(solid >= 0 for solid, _ in solids.values())
    return SurfaceMesh(
        points=points,
        triangles=np.concatenate([triangles[face] for face in faces]),
        face_ids=face_ids,
        solid_ids=[solids[face] for face in face_ids.tolist()] if known else None,
        groups=MeshGroups.of_plain(record["groups"]),
    )
