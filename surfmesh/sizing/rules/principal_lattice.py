"""Does a lattice of triangles, laid along principal directions at one place, lie so everywhere?

The core looks for that by the bracket of two steps: see ``src/sizing/principal_lattice.hpp``.
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import sizing as core
from surfmesh._core.sizing import LEAST_ROWS
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.rules.size_rules import SizeRules

__all__ = ["LEAST_ROWS", "keeps_lattice"]


def keeps_lattice(surface: Surface, extent: NDArray[np.float64], rules: SizeRules) -> bool:
    """extent: (2,) of the surface's chart. rules: for such a lattice."""
    if rules.sizing.has_law or not rules.follows_curvature:
        return False
    width, height = extent.tolist()
    return core.keeps_lattice(
        as_core_surface(surface), (width, height), rules.core, rules.sizing.gradient
    )
