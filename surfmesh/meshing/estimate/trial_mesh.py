"""A small mesh is made rather than estimated: boundary nodes are integers, and few.

Nothing is known of a mesh of some hundred triangles that is cheaper to find out than the mesh.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from surfmesh.errors import SurfmeshError
from surfmesh.meshing.progress import Progress, WorkBudget
from surfmesh.result.surface_mesh import SurfaceMesh

WHOLE, WHOLE_STRETCHED = 5_000, 10_000
"""Up to so many triangles all are made; where sizes depend on the direction more, as edges that
are made finer for one face have more triangles on the next."""

ROUNDS = 4
"""How often at most: what comes later are a few places."""

BUDGET = 500_000
"""Units of work, see ``WorkBudget``: a model that needs more is left to the estimate."""


def counts_within_budget(make: Callable[[Progress], SurfaceMesh]) -> np.ndarray | None:
    """Triangles on each face (f,) of the mesh that ``make`` makes, stopped by its progress.

    None where it fails, or needs too much work.
    """
    try:
        mesh = make(WorkBudget(BUDGET))
    except SurfmeshError:
        return None
    return np.bincount(mesh.face_ids, minlength=len(mesh.surfaces))
