"""Manifests: what files were made with, and their hashes, for another machine to compare.

No time, no paths and nothing measured is in them: the same input, options and versions give the
same manifest, byte by byte.
"""

import json
import platform
import sys
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from surfmesh.errors import FileFormatError
from surfmesh.io.asked_date import VARIABLE, asked_date
from surfmesh.io.atomic import replacing
from surfmesh.quality.figures.provenance import (
    mesh_sha256,
    options_of,
    plain,
    version_of,
    versions,
)
from surfmesh.result.model_facts import file_sha256
from surfmesh.result.surface_mesh import SurfaceMesh

MANIFEST_VERSION = 1  # raised when an entry changes its meaning or goes away
LARGEST = 1 << 24  # bytes of a manifest
DECISIVE = ("mesh", "files")  # sections that have to agree
_SECTIONS = ("versions", "machine", "options", "inputs", "mesh", "files")
_WRITE = {  # packages that write a file of this extension
    ".med": ("meshio", "h5py"),
    ".png": ("pyvista", "vtk", "matplotlib", "pillow"),
    ".svg": ("matplotlib",),
}


class Entry(NamedTuple):
    """One entry of two manifests; None where it is in the other alone."""

    section: str
    name: str
    here: Any
    there: Any

    @property
    def agrees(self) -> bool:
        return type(self.here) is type(self.there) and self.here == self.there

    def to_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return self._asdict() | {"agrees": self.agrees, "decisive": self.decisive}

    @property
    def decisive(self) -> bool:
        """Whether the two are not of the same mesh or files when it differs."""
        return self.section in DECISIVE


@dataclass(frozen=True, kw_only=True)
class Manifest:
    """Sections of plain values by name."""

    versions: Mapping[str, Any]  # of Python and the packages at work
    machine: Mapping[str, Any]  # system, architecture, byte order
    options: Mapping[str, Any] = field(default_factory=dict)  # the sizing, and what else was asked
    inputs: Mapping[str, Any] = field(default_factory=dict)  # SHA-256 by file name
    mesh: Mapping[str, Any] = field(default_factory=dict)  # order, points, triangles, sha256
    files: Mapping[str, Any] = field(default_factory=dict)  # SHA-256 by file name

    @classmethod
    def of(
        cls,
        mesh: SurfaceMesh,
        files: Iterable[str | Path] = (),
        *,
        inputs: Iterable[str | Path] = (),
        options: Mapping[str, Any] | None = None,
    ) -> "Manifest":
        """Of ``mesh`` and the ``files`` it was written to.

        inputs: files it was made from; what the mesh itself knows of is in it anyway. options:
        what was asked for beside the sizing. Raises ``FileFormatError`` for a file that cannot
        be read, or two of one name.
        """
        hashes, sources = _hashes(files), _hashes(inputs)
        if mesh.facts is not None and mesh.facts.sha256 is not None:
            sources[Path(mesh.facts.source).name or "surface"] = mesh.facts.sha256
        asked = dict(options or {}) | {"sizing": options_of(mesh.sizing)}
        if asked_date() is not None:
            asked[VARIABLE] = f"{asked_date():%Y-%m-%dT%H:%M:%SZ}"
        return cls(
            versions=_versions(mesh, hashes),
            machine=_machine(),
            options=plain(asked),
            inputs=sources,
            mesh={
                "order": mesh.order,
                "points": len(mesh.points),
                "triangles": len(mesh.triangles),
                "sha256": mesh_sha256(mesh),
            },
            files=hashes,
        )

    @classmethod
    def read(cls, path: str | Path) -> "Manifest":
        """From a file. Raises ``FileFormatError`` when it is none of a version known here."""
        path = Path(path)
        found = _parsed(path)
        if found.get("manifest_version") != MANIFEST_VERSION:
            raise FileFormatError(f"{path}: is no manifest of version {MANIFEST_VERSION}")
        for section in _SECTIONS:
            if not isinstance(found.get(section), dict):
                raise FileFormatError(f"{path}: a manifest needs a section {section!r}")
        for name, digest in found["files"].items():
            if Path(name).name != name or "\0" in name:
                raise FileFormatError(f"{path}: {name[:80]!r} is no name of a file")
            if not isinstance(digest, str):
                raise FileFormatError(f"{path}: {name[:80]!r} has no hash")
        if not isinstance(found["mesh"].get("sha256"), str):
            raise FileFormatError(f"{path}: the mesh has no hash")
        return cls(**{section: found[section] for section in _SECTIONS})

    def to_json(self) -> str:
        """JSON text with sorted keys."""
        values = {"manifest_version": MANIFEST_VERSION} | asdict(self)
        return json.dumps(values, indent=2, sort_keys=True, allow_nan=False)

    def save(self, path: str | Path) -> Path:
        """Write it to ``path``, all or nothing."""
        with replacing(Path(path)) as temporary:
            temporary.write_text(self.to_json() + "\n", encoding="utf-8", newline="\n")
        return Path(path)

    def compared(self, other: "Manifest") -> tuple[Entry, ...]:
        """Every entry of both, side by side."""
        return tuple(
            entry
            for section in _SECTIONS
            for entry in _entries(section, getattr(self, section), getattr(other, section))
        )

    def compared_with_folder(self, folder: str | Path) -> tuple[Entry, ...]:
        """Its files as they are in ``folder``, and the versions at work here.

        Raises ``FileFormatError`` for a file that is there and cannot be read, or when there is
        none to look for.
        """
        if not self.files:
            raise FileFormatError("the manifest names no files; compare it with another manifest")
        there = [Path(folder, name) for name in self.files]
        found = _hashes(path for path in there if path.exists())
        here: dict[str, Mapping[str, str | None]] = {
            "versions": {name: _version(name) for name in self.versions},
            "machine": _machine(),
            "files": found,
        }
        return tuple(
            entry
            for section, values in here.items()
            for entry in _entries(section, getattr(self, section), values)
        )


def _entries(section: str, here: Mapping[str, Any], there: Mapping[str, Any]) -> Iterable[Entry]:
    """Side by side; what lies within an entry has its name after a dot."""
    for name in sorted({*here, *there}):
        one, other = here.get(name), there.get(name)
        if isinstance(one, Mapping) and isinstance(other, Mapping):
            for entry in _entries(section, one, other):
                yield entry._replace(name=f"{name}.{entry.name}")
        else:
            yield Entry(section, name, one, other)


def _hashes(paths: Iterable[str | Path]) -> dict[str, str]:
    found: dict[str, str] = {}
    for path in map(Path, paths):
        if path.name in found:
            raise FileFormatError(f"{path}: a manifest has one file of this name already")
        try:
            found[path.name] = file_sha256(path)
        except OSError as error:
            raise FileFormatError(f"{path}: cannot be read: {error.strerror}") from error
    return found


def _versions(mesh: SurfaceMesh, files: Iterable[str]) -> dict[str, str]:
    names = {"sympy", "shapely", "zlib", *versions(mesh)}
    for file in files:
        names.update(_WRITE.get(Path(file).suffix.lower(), ()))
    return {name: known for name in sorted(names) if (known := _version(name)) is not None}


def _version(name: str) -> str | None:
    """Of a package, of Python or of zlib, which compresses files."""
    if name == "zlib":
        return zlib.ZLIB_RUNTIME_VERSION
    return platform.python_version() if name == "python" else version_of(name)


def _machine() -> dict[str, str]:
    return {
        "system": platform.system(),
        "architecture": platform.machine(),
        "byte order": sys.byteorder,
    }


def _parsed(path: Path) -> dict[str, Any]:
    try:
        if path.stat().st_size > LARGEST:
            raise FileFormatError(f"{path}: is too large for a manifest")
        found = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileFormatError(f"{path}: cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError):
        raise FileFormatError(f"{path}: is no manifest: not a JSON text") from None
    if not isinstance(found, dict):
        raise FileFormatError(f"{path}: is no manifest: not a JSON object")
    return found
