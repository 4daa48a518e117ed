"""Angles between the normals of triangles and surface, and which of them the surface makes."""

import math

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import patch as core
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.options.defaults import FINEST_SIZE, LEAST_OF_CHORD

FOLDED, INVERTED = math.cos(math.radians(60.0)), 0.0
"""Cosines between the two normals below which a triangle is folded, or turned over."""


def cosines_with_surface(
    surface: Surface, corners: NDArray[np.float64], uv: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Of the angles between triangles (n, 3, 3) and the surface's normals at uv (n, 2)."""
    return core.cosines_with_surface(as_core_surface(surface), corners, uv)


def sharp_radius(chord: float | None, diagonal: float) -> float:
    """Radius below which a surface is said to bend sharply: no triangle is small enough there.

    diagonal: of the box of the mesh; all in model units.
    """
    return max(LEAST_OF_CHORD * (chord or 0.0), FINEST_SIZE * diagonal)
