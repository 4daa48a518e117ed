"""What a mesh was made with, and a fingerprint of what came out."""

import hashlib
import platform
import sys
from functools import cache
from importlib.metadata import PackageNotFoundError, version

import numpy as np

from surfmesh.surface_mesh import SurfaceMesh

_ALWAYS = ("surfmesh", "numpy", "scipy", "numba")
_CAD = ("cadquery", "cadquery-ocp")


def versions(mesh: SurfaceMesh) -> dict[str, str]:
    """Name -> version of Python and of the packages that matter for this mesh.

    The CAD packages are named when the mesh is of a CAD model, or they are at work here.
    """
    cad = "OCP" in sys.modules or (mesh.facts is not None and bool(mesh.facts.faces))
    names = _ALWAYS + (_CAD if cad else ())
    found = {"python": platform.python_version()}
    return found | {name: known for name in names if (known := _version(name)) is not None}


@cache
def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def mesh_sha256(mesh: SurfaceMesh) -> str:
    """SHA-256 of the points (float64) and triangles (int32), little-endian, one after the other."""
    digest = hashlib.sha256(np.ascontiguousarray(mesh.points, "<f8"))
    digest.update(np.ascontiguousarray(mesh.triangles, "<i4"))
    return digest.hexdigest()
