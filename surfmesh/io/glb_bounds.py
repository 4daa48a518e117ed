"""What a binary glTF file of another program may announce, looked at before trimesh reads it.

Format: Khronos glTF 2.0 specification, sections 3.5 (scenes), 3.6 (buffers, accessors).
"""

from pathlib import Path
from typing import Any

from surfmesh.errors import FileFormatError
from surfmesh.io.expansion import Expansion

COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
DEEPEST = 200  # nodes below each other; each is a product of matrices for all that are below


def require_bounded(path: Path, content: dict[str, Any], size: int) -> None:
    """Raise ``FileFormatError`` for a buffer in another file, for more numbers than the file
    holds, and for nodes that are no tree or show the same meshes too often. size: of the file.
    """
    for number, buffer in enumerate(content.get("buffers", [])):
        uri = buffer.get("uri")
        if uri is not None and not str(uri).startswith("data:"):
            raise FileFormatError(
                f"{path}: its buffer {number} is another file, which is not opened; save it with "
                "all data in it"
            )
    views = content.get("bufferViews", [])
    for number, view in enumerate(views):
        _count(path, f"bufferView {number}", view, "byteLength", size)
    bytes_of = []
    for number, accessor in enumerate(content.get("accessors", [])):
        width = COMPONENT_BYTES.get(accessor.get("componentType"), 1)
        width *= COMPONENTS.get(accessor.get("type"), 1)
        view = accessor.get("bufferView")
        if view is None or not 0 <= view < len(views):
            there = size  # all zero, but for values given one by one
        else:
            there = views[view]["byteLength"]
        _count(path, f"accessor {number}", accessor, "count", there // width)
        bytes_of.append(width * accessor["count"])
    _require_tree(path, content.get("nodes", []))
    expansion = Expansion(path, size)
    shown = [
        sum(bytes_of[number] for entry in mesh["primitives"] for number in _accessors(entry))
        for mesh in content.get("meshes", [])
    ]
    for node in content.get("nodes", []):
        if "mesh" in node:
            expansion.take(shown[node["mesh"]])


def _count(path: Path, what: str, entry: dict[str, Any], name: str, most: int) -> None:
    found = entry.get(name)
    if not isinstance(found, int) or not 0 <= found <= most:
        raise FileFormatError(
            f"{path}: {what} has {name} {str(found)[:40]}, and the file holds {most}: it is damaged"
        )


def _accessors(primitive: dict[str, Any]) -> list[int]:
    """The arrays of a primitive, of whatever meaning."""
    indices = [primitive["indices"]] if "indices" in primitive else []
    return [*indices, *primitive["attributes"].values()]


def _require_tree(path: Path, nodes: list[dict[str, Any]]) -> None:
    """Every node below one other at most, none below itself."""
    parent = [-1] * len(nodes)
    for number, node in enumerate(nodes):
        for child in node.get("children", []):
            if not 0 <= child < len(nodes) or parent[child] >= 0:
                raise FileFormatError(f"{path}: its nodes are no tree: see node {number}")
            parent[child] = number
    for number in range(len(nodes)):
        at, depth = number, 0
        while at >= 0:
            at, depth = parent[at], depth + 1
            if depth > DEEPEST:
                raise FileFormatError(
                    f"{path}: its nodes are below each other more than {DEEPEST} times or in a ring"
                )
