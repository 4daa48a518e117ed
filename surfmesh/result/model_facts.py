"""What is known of a model beforehand: what its mesh is compared with. Plain data, no CAD."""

import hashlib
from dataclasses import dataclass
from pathlib import Path

_CHUNK = 1 << 20  # bytes of a file hashed at a time


@dataclass(frozen=True)
class FaceFacts:
    """A face of the model, by the same number as in ``SurfaceMesh.face_ids``."""

    kind: str  # plane, cylinder, b-spline, ...
    area: float  # exact, square model units


@dataclass(frozen=True)
class SolidFacts:
    """A solid of the model, by the same number as in ``SurfaceMesh.solid_ids``."""

    name: str
    area: float  # of all its faces
    volume: float  # positive, cubic model units
    euler: int | None  # V - E + F of its boundary; None: it has none to compare with
    closed: bool


@dataclass(frozen=True, kw_only=True)
class ModelFacts:
    """Exact figures of a model, and where it came from. None or empty: not known."""

    source: str = ""  # the file, or what else it was made from
    sha256: str | None = None  # of the file, or of the formulas
    unit: str = ""  # of lengths
    area: float | None = None  # of all faces, shared ones once
    volume: float | None = None  # of all solids
    euler: int | None = None  # V - E + F of all faces together
    crosses_itself: bool = False  # by nature, as Klein's bottle does: no fault of the mesh
    faces: tuple[FaceFacts, ...] = ()
    solids: tuple[SolidFacts, ...] = ()
    # by ``SurfaceMesh.edge_ids``: how often faces use each edge, and so triangles those along it
    edge_uses: tuple[int, ...] = ()
    # by place in ``SurfaceMesh.vertex_ids``: fans of faces at each vertex, mostly one; 0 where
    # another vertex stands for it
    vertex_fans: tuple[int, ...] = ()
    healing: tuple[str, ...] = ()  # what was changed on the way, one sentence each


def file_sha256(path: str | Path) -> str:
    """Hexadecimal SHA-256 of a file's bytes."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while chunk := file.read(_CHUNK):
            digest.update(chunk)
    return digest.hexdigest()
