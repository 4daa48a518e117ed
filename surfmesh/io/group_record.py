"""Groups as one JSON text in lines of ASCII without blanks, for comments and the like.

Formats that cannot hold colours, kinds of surface, units or the names of what has no elements
carry them so; other programs pass over comments. What a format can hold itself is written in
its own way too.
"""

import json
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.surface_mesh import SurfaceMesh

MARK = "surfmesh-groups "
CAD_NUMBERS: dict[str, tuple[int, ...]] = {  # fields and the shapes of their arrays
    "edge_segments": (-1, 2), "edge_ids": (-1,), "vertex_ids": (-1,)
}  # fmt: skip
WIDTH = 64  # characters a line: fits into cards of 72 and 80 columns


def group_lines(mesh: SurfaceMesh, numbered: bool = False) -> list[str]:
    """Lines of ``MARK`` and a piece of the text.

    numbered: with the face of each triangle and the nodes on edges and vertices of CAD, for
    formats that keep the order of nodes and triangles but do not hold these.
    """
    record: dict[str, Any] = {"groups": mesh.groups.plain()}
    if numbered:
        starts = np.flatnonzero(np.diff(mesh.face_ids, prepend=mesh.face_ids[:1] - 1))
        counts = np.diff(starts, append=len(mesh.face_ids))
        record["runs"] = np.column_stack((mesh.face_ids[starts], counts)).tolist()
        record |= {name: numbers.tolist() for name, numbers in cad_numbers(mesh).items()}
    if mesh.solid_ids is not None:
        record["solids"] = solids_of_faces(mesh).tolist()
    text = json.dumps(record, separators=(",", ":"))
    text = text.replace(" ", "\\u0020").replace("$", "\\u0024")  # $End ends sections of .msh
    text = f"{len(text)}:{text}"
    return [MARK + text[at : at + WIDTH] for at in range(0, len(text), WIDTH)]


def group_fields(
    lines: Iterable[str], triangles: int, face_ids: NDArray | None = None
) -> dict[str, Any]:
    """Fields of a SurfaceMesh from the lines that start with ``MARK``; {} when there are none.

    Marks of comments before it are passed over. triangles: the number m of them; face_ids: (m,)
    where the format has them. A text that is damaged, or of another mesh, raises ValueError.
    """
    marked = (line.removeprefix("comment").lstrip("$#*% ") for line in lines)
    pieces = [line.removeprefix(MARK).strip() for line in marked if line.startswith(MARK)]
    if not pieces:
        return {}
    length, _, text = "".join(pieces).partition(":")
    if length != str(len(text)):
        raise ValueError(f"the record of groups has {len(text)} characters instead of {length}")
    record = json.loads(text)
    if not isinstance(record, dict) or not isinstance(record.get("groups"), dict):
        raise ValueError("the record of groups is damaged")
    found: dict[str, Any] = {"groups": MeshGroups.of_plain(record["groups"])}
    found |= as_cad_numbers(record)
    if face_ids is None and "runs" in record:
        runs = np.array(record["runs"], np.int64).reshape(-1, 2)
        if (runs[:, 1] < 0).any() or sum(runs[:, 1].tolist()) != triangles:
            raise ValueError(f"the record of groups is not of {triangles} triangles")
        found["face_ids"] = face_ids = np.repeat(runs[:, 0], runs[:, 1])
    if face_ids is not None and "solids" in record:
        solids = np.array(record["solids"], np.int32).reshape(-1, 2)
        faces = np.asarray(face_ids)
        if len(faces) and not 0 <= int(faces.min()) <= int(faces.max()) < len(solids):
            raise ValueError(f"the record of groups knows the solids of {len(solids)} faces only")
        found["solid_ids"] = solids[face_ids]
    return found


def cad_numbers(mesh: SurfaceMesh) -> dict[str, NDArray[np.int32]]:
    """What is known of the edges and vertices of a CAD model, by the names of its fields."""
    held = ((name, getattr(mesh, name)) for name in CAD_NUMBERS)
    return {name: numbers for name, numbers in held if numbers is not None}


def as_cad_numbers(record: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a SurfaceMesh of what ``cad_numbers`` gave; there may be more in ``record``."""
    return {
        name: np.asarray(record[name]).reshape(shape)
        for name, shape in CAD_NUMBERS.items()
        if name in record
    }


def require_last_line(path: Path) -> None:
    """Raise ``FileFormatError`` for a file of ours whose last line has no end: digits are gone.

    For formats without an end mark, when they hold a record of groups. Files of other programs
    may end without.
    """
    with open(path, "rb") as file:
        file.seek(-1, os.SEEK_END)
        if file.read(1) not in b"\r\n":
            raise FileFormatError(f"{path}: is cut: its last line has no end")


def solids_of_faces(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """(f, 2) the solids behind and before each face, -1 where there is none."""
    solids = np.full((int(mesh.face_ids.max(initial=-1)) + 1, 2), -1, np.int32)
    if mesh.solid_ids is not None:
        solids[mesh.face_ids] = mesh.solid_ids  # the same for all triangles of a face
    return solids


def numbers_by_label(
    numbers: Iterable[int], label: Callable[[int], str]
) -> dict[str, list[int]]:  # fmt: skip
    """The numbers that have each label, in their order: what has one name is one group in files."""
    found: dict[str, list[int]] = {}
    for number in numbers:
        found.setdefault(label(number), []).append(number)
    return found


def unique_labels(labels: Iterable[str], longest: int, allowed: str = "") -> list[str]:
    """Labels of letters, digits, '_' and ``allowed`` alone, each but once, in any case."""
    taken: set[str] = set()
    found = []
    for label in labels:
        kept = (c if (c.isascii() and c.isalnum()) or c in allowed else "_" for c in label)
        plain = "".join(kept)[:longest] or "_"
        plain = plain if plain[0].isalpha() else ("_" + plain)[:longest]
        name, count = plain, 1
        while name.upper() in taken:
            count += 1
            name = f"{plain[: longest - 1 - len(str(count))]}_{count}"
        taken.add(name.upper())
        found.append(name)
    return found
