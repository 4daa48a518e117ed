"""What a mesh was made with, and a fingerprint of what came out."""

import hashlib
import math
import platform
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields, is_dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np

from surfmesh.quality.figures.part import Part
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.result.surface_mesh import SurfaceMesh

_ALWAYS = ("surfmesh", "numpy", "scipy")
_CAD = ("cadquery", "cadquery-ocp")


@dataclass(frozen=True, kw_only=True)
class Provenance(Part):
    """Where the mesh comes from."""

    unit: str  # of lengths; empty when it is not known
    source: str  # the file, or what else the mesh was made from
    source_sha256: str | None
    mesh_sha256: str  # of points and triangles
    versions: Mapping[str, str]  # of the packages at work
    healing: tuple[str, ...]  # what was changed in the model

    @classmethod
    def of(cls, measured: Measurements) -> "Provenance":
        """What is known of the model beforehand, and what is at work here."""
        facts, mesh = measured.facts, measured.mesh
        return cls(
            unit=facts.unit,
            source=facts.source,
            source_sha256=facts.sha256,
            mesh_sha256=mesh_sha256(mesh),
            versions=versions(mesh),
            healing=facts.healing,
        )


def versions(mesh: SurfaceMesh) -> dict[str, str]:
    """Name -> version of Python and of the packages that matter for this mesh.

    The CAD packages are named when the mesh is of a CAD model, or they are at work here.
    """
    cad = "OCP" in sys.modules or (mesh.facts is not None and bool(mesh.facts.faces))
    names = _ALWAYS + (_CAD if cad else ())
    found = {"python": platform.python_version()}
    return found | {name: known for name in names if (known := version_of(name)) is not None}


@cache
def version_of(package: str) -> str | None:
    """None when it is not installed."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def mesh_sha256(mesh: SurfaceMesh) -> str:
    """SHA-256 of the points (float64) and triangles (int32), little-endian, one after the other."""
    digest = hashlib.sha256(np.ascontiguousarray(mesh.points, "<f8").data)
    digest.update(np.ascontiguousarray(mesh.triangles, "<i4").data)
    return digest.hexdigest()


def options_of(sizing: Any) -> dict[str, Any]:
    """What ``sizing`` asks for, by name."""
    if not is_dataclass(sizing):
        return {} if sizing is None else {"sizing": _said(sizing)}
    return {item.name: getattr(sizing, item.name) for item in fields(sizing)}


def plain(value: Any) -> Any:
    """``value`` as JSON knows it; callables and other objects by their repr."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, (Sequence, np.ndarray)):
        return [plain(item) for item in value]
    if isinstance(value, (int, np.integer)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    if is_dataclass(value) and not isinstance(value, type):
        return plain(asdict(value))
    return _said(value)


def _said(value: Any) -> str:
    """Its repr without places in memory, which differ every time."""
    return re.sub(r" at 0x[0-9a-fA-F]+", "", repr(value))
