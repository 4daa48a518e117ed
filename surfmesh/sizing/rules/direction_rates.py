"""How long an edge may be along the direction of low curvature before that leaves the edge.

The formulas are those of the core, see src/sizing/direction_rates.hpp.
"""

import numpy as np

from surfmesh._core import sizing as core
from surfmesh._core.sizing import BENDING, FANNING, ROUND
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface, surface_kind

__all__ = [
    "BENDING", "EVEN", "FANNING", "ROUND", "direction_rates", "has_even_curvature",
    "longest_along",
]  # fmt: skip

EVEN = ("plane", "cylinder", "sphere")
"""Kinds of CAD surfaces whose curvatures are the same everywhere."""


def has_even_curvature(surface: Surface) -> bool:
    """Are the curvatures known to be the same everywhere?"""
    return surface_kind(surface) in EVEN


def direction_rates(
    surface: Surface, uv: np.ndarray, along_first: np.ndarray, size: np.ndarray
) -> np.ndarray:
    """|K_t| and |k_n| (n, 2), 1 / model unit^2, at uv (n, 2); zero where they are not known.

    along_first: (n,) bool, is t the first principal direction? size: (n,) a length.
    """
    if has_even_curvature(surface):
        return np.zeros((len(uv), 2))
    return core.direction_rates(
        as_core_surface(surface), np.ascontiguousarray(uv, float),
        np.ascontiguousarray(size, float), np.ascontiguousarray(along_first, np.uint8),
    )  # fmt: skip


def longest_along(
    rates: np.ndarray, k1: np.ndarray, k2: np.ndarray, size: np.ndarray, chord: float
) -> np.ndarray:
    """Largest length (n,) of triangles that are ``size`` (n,) wide; at least that."""
    rates, k1, k2, size = (np.ascontiguousarray(x, float) for x in (rates, k1, k2, size))
    return core.longest_along(rates, k1, k2, size, chord)
