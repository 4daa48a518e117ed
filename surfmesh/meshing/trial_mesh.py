"""A small mesh is made rather than estimated: boundary nodes are integers, and few.

Nothing is known of a mesh of some hundred triangles that is cheaper to find out than the mesh.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np

from surfmesh.errors import SurfmeshError
from surfmesh.meshing.stages import Progress
from surfmesh.surface_mesh import SurfaceMesh

WHOLE = 5000
"""Up to so many triangles all are made."""

SECONDS = 3.0
"""A model that takes longer than such a mesh may is left to the estimate."""


def tried(make: Callable[[Progress], SurfaceMesh]) -> np.ndarray | None:
    """Triangles on each face (f,) of the mesh that ``make`` makes, stopped by its progress.

    None where it fails, or takes too long.
    """
    start = perf_counter()
    try:
        mesh = make(lambda stage, share: perf_counter() - start < SECONDS)
    except SurfmeshError:
        return None
    return np.bincount(mesh.face_ids, minlength=len(mesh.surfaces))
