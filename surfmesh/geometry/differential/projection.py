"""The closest point of a surface, near a guess: how far is a mesh from what it stands for?"""

from __future__ import annotations

import numpy as np

from surfmesh._core import surfaces as core
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface


def closest_point(
    surface: Surface,
    points: np.ndarray,
    uv_guess: np.ndarray,
    steps: int = 2,
    margin: float = core.PROJECTION_MARGIN,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nearest points of a surface to points, from guesses, never farther than these.

    points: (n, 3), uv_guess: (n, 2). margin: fraction of the domain by which they may leave it.
    Returns uv (n, 2), distance (n,), foot (n, 3). The search is local: a nearer part of the
    surface that the guess does not lead to is not found.
    """
    points = np.ascontiguousarray(points, dtype=float).reshape(-1, 3)
    guess = np.ascontiguousarray(uv_guess, dtype=float).reshape(-1, 2)
    return core.closest_points(as_core_surface(surface), points, guess, steps, margin)
