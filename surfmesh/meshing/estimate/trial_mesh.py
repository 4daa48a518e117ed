"""A small mesh is made rather than estimated: boundary nodes are integers, and few.

Nothing is known of a mesh of some hundred triangles that is cheaper to find out than the mesh. A
larger one is made where its first round does not tell the last: where sizes are too coarse for the
curvature triangles are folded, and how fine they become then only the mesh knows.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from surfmesh.cad.model.centres import cell_centres
from surfmesh.errors import SurfmeshError
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.progress import Progress, WorkBudget
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.options.sizing import Sizing

GRID = 24
"""Points each way at which it is looked at how far a surface turns."""

FEW = 600
"""Up to so many triangles all are made."""

LARGEST_TURN = 1.1
"""Radians that the surface turns by along an edge. Beyond it triangles may be folded."""

WHOLE, WHOLE_STRETCHED = 5_000, 10_000
"""The same where the first round does not tell all; where sizes depend on the direction more, as
edges that are made finer for one face have more triangles on the next."""

LESS_STRETCHED = 4.0
"""So many times fewer triangles than their bound says, about, where sizes depend on the direction:
3.7 to 300 on all but two of thirty random parts. Below it faces are not counted before."""

ROUNDS = 4
"""How often at most: what comes later are a few places."""

BUDGET = 500_000
"""Units of work, see ``WorkBudget``: a model that needs more is left to the estimate."""


def is_one_round(sizing: Sizing) -> bool:
    """Do sizes ask for nothing that only a mesh shows, but for folds?"""
    later = sizing.proof or sizing.is_curved or sizing.volume is not None or sizing.fewest
    return not (later or sizing.is_anisotropic)


def largest_turn(surface: Surface, field: SizeField) -> float:
    """Radians that the surface turns by along an edge, at most, at points of a grid."""
    xy = cell_centres(GRID) * field.chart.extent
    _, *derivatives = surface.evaluate(field.chart.to_uv(xy), 2)
    forms = forms_from_derivatives(*derivatives)
    k = curvatures(forms)
    turns = field.sizes(xy) * np.maximum(np.abs(k.k1), np.abs(k.k2))
    return float(turns[~forms.degenerate & np.isfinite(turns)].max(initial=0.0))


def counts_within_budget(make: Callable[[Progress], SurfaceMesh]) -> np.ndarray | None:
    """Triangles on each face (f,) of the mesh that ``make`` makes, stopped by its progress.

    None where it fails, or needs too much work.
    """
    try:
        mesh = make(WorkBudget(BUDGET))
    except SurfmeshError:
        return None
    return np.bincount(mesh.face_ids, minlength=len(mesh.surfaces))
