"""Where a surface itself turns over: at a cusp, a crease, a swallowtail, a tube of no width."""

import numpy as np

from surfmesh._core import surfaces as core
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface


def bends_sharply(surface: Surface, triangles: np.ndarray, radius: float) -> np.ndarray:
    """Does the surface bend with less than ``radius`` within triangles (k, 3, 2) of (u, v)? (k,).

    radius: model units. Bends are found where the curvature of a sample shows them, or where
    the normals of two samples differ.
    """
    triangles = np.ascontiguousarray(triangles, dtype=float)
    return core.bends_sharply(as_core_surface(surface), triangles, radius).astype(bool)
