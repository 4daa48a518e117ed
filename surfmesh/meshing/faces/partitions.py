"""Meshes of faces that stay where they were made: in files that all workers see.

A face's arrays go to a file of the folder; what comes back to the caller are the triangles at its
boundary, which its neighbours meet, and its counts. These are enough for the rounds of meshing, for
numbering what faces share, and for finding chords that two faces have in common. Whole faces are
read again by whoever writes the partitions.
"""

import hashlib
import io
import os
import re
import secrets
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Self

import numpy as np

from surfmesh.errors import MeshingError
from surfmesh.meshing.faces.face_data import FaceMesh

MARK = "shared"
"""A file that the caller puts into the folder: who does not see it sees another folder."""

_NAME = re.compile(r"faces-[0-9a-f]{16}")

ARRAYS = ("points", "slots", "triangles", "uv_points", "uv_triangles", "sizes", "inverse_sizes")


@dataclass(frozen=True, kw_only=True)
class StoredFaceMesh(FaceMesh):
    """A face in a file. Its arrays hold all points on its boundary, and of its triangles and other
    points those at one of them."""

    file: str
    """Path of the whole face."""
    all_triangles: int
    all_inner: int
    """Points that are not on its boundary."""
    all_corners: int
    """Rows of the whole ``uv_points``."""

    @property
    def count(self) -> int:
        return self.all_triangles

    def whole(self) -> FaceMesh:
        try:
            with np.load(self.file, allow_pickle=False) as held:
                arrays = {name: held[name] for name in held.files}
        except (OSError, ValueError) as error:
            raise MeshingError(f"the mesh of a face is lost: {self.file}: {error}") from error
        known = {f.name: getattr(self, f.name) for f in fields(FaceMesh) if f.name not in ARRAYS}
        return FaceMesh(**known, **arrays)


@dataclass(frozen=True)
class FaceStore:
    """A folder for meshes of faces; it travels to the workers."""

    folder: str

    @classmethod
    def made_in(cls, place: Path) -> Self:
        """A new folder in ``place``. Raises ``OSError``."""
        folder = place / f"faces-{secrets.token_hex(8)}"
        folder.mkdir()
        (folder / MARK).touch()
        return cls(str(folder.resolve()))

    @classmethod
    def all_in(cls, place: Path) -> list[Self]:
        """Those that were made in ``place`` and are there, of whatever process."""
        names = (entry for entry in place.glob("faces-*") if _NAME.fullmatch(entry.name))
        return [cls(str(folder)) for folder in names if (folder / MARK).is_file()]

    @property
    def mark(self) -> Path:
        """The file that says that the folder is there."""
        return Path(self.folder, MARK)

    def kept(self, mesh: FaceMesh) -> FaceMesh:
        """Put a face into a file; one without triangles stays as it is.

        Raises ``MeshingError`` where the folder is not there, or cannot be written.
        """
        if mesh.is_empty:
            return mesh
        mesh = _without_unused(mesh.whole())
        held = {name: getattr(mesh, name) for name in ARRAYS}
        content = io.BytesIO()
        np.savez(content, **{name: values for name, values in held.items() if values is not None})
        data = content.getvalue()
        # the same face has the same name, whoever makes it, and however often
        path = Path(self.folder, f"{hashlib.sha256(data).hexdigest()[:32]}.npz")
        try:
            if not self.mark.is_file():
                raise FileNotFoundError(2, "it is not there")
            temporary = path.with_suffix(f".{os.getpid()}-{secrets.token_hex(4)}")
            temporary.write_bytes(data)
            temporary.replace(path)
        except OSError as error:
            raise MeshingError(
                f"a worker cannot write to {self.folder} ({error.strerror}): the folder of a .pvtu "
                "file must be one that all workers and the caller share"
            ) from None
        return _at_boundary(mesh, str(path))

    def remove(self) -> None:
        """Remove the folder with all that is in it."""
        import shutil

        shutil.rmtree(self.folder, ignore_errors=True)


def _without_unused(mesh: FaceMesh) -> FaceMesh:
    """Without inner points that no triangle has."""
    used = mesh.slots >= 0
    used[mesh.triangles.ravel()] = True
    rank = np.cumsum(used) - 1
    return replace(
        mesh, points=mesh.points[used], slots=mesh.slots[used], sizes=mesh.sizes[used],
        triangles=rank[mesh.triangles],
    )  # fmt: skip


def _at_boundary(mesh: FaceMesh, file: str) -> StoredFaceMesh:
    bounding = mesh.slots >= 0
    near = bounding[mesh.triangles].any(axis=1)
    kept = bounding.copy()
    kept[mesh.triangles[near].ravel()] = True
    rank = np.cumsum(kept) - 1
    corners, local = np.unique(mesh.uv_triangles[near], return_inverse=True)
    known = {f.name: getattr(mesh, f.name) for f in fields(FaceMesh) if f.name not in ARRAYS}
    return StoredFaceMesh(
        **known,
        points=mesh.points[kept],
        slots=mesh.slots[kept],
        sizes=mesh.sizes[kept],
        triangles=rank[mesh.triangles[near]],
        uv_points=mesh.uv_points[corners],
        uv_triangles=local.reshape(-1, 3),
        inverse_sizes=None if mesh.inverse_sizes is None else mesh.inverse_sizes[corners],
        file=file,
        all_triangles=len(mesh.triangles),
        all_inner=int((~bounding).sum()),
        all_corners=len(mesh.uv_points),
    )
