"""How long an edge may be along the direction of low curvature before that leaves the edge.

Let t be the principal direction with the smaller curvature k, n the one with the larger K. By
the equations of Codazzi the lines of curvature along t bend within the surface at the rate
k_n / (K - k), and they fan out at the rate K_t / (K - k), where k_n is the derivative of k in
the direction n (do Carmo, 4-3). In the frame of one point the surface has the cubic terms

    k_n x^2 y / 2 + K_t x y^2 / 2,

to be compared with K y^2 / 2 over a triangle of length x and width y: where they are no longer
small beside what the larger curvature takes of the chord, a shorter triangle does with less.
"""

import numpy as np

from surfmesh.geometry.differential.fundamental_forms import (
    PrincipalCurvatures,
    curvatures,
    forms_from_derivatives,
)
from surfmesh.geometry.surface import Surface, surface_kind

BENDING, FANNING = 0.7, 0.29
"""Largest k_n x^2 y and K_t x y^2, as a share of K y^2. At the latter the width that the curvature
allows changes by 18% over the length, as fast as ``growth`` lets it by default: longer triangles
would have to be narrower, all the way to where the direction has fanned out."""

SAG, DECIDED = 6.0, 3.0
"""K y^2 in terms of ``chord`` where it decides: an eighth of it is used."""

ROUND = 1.5
"""Ratio of two sizes up to which their directions do not matter."""

EVEN = ("plane", "cylinder", "sphere")
"""Kinds of CAD surfaces whose curvatures are the same everywhere."""

STEP = 0.02
"""In shorter sizes: the way over which curvatures are compared."""


def has_even_curvature(surface: Surface) -> bool:
    """Are the curvatures known to be the same everywhere?"""
    return surface_kind(surface) in EVEN


def direction_rates(
    surface: Surface, uv: np.ndarray, k: PrincipalCurvatures, along_first: np.ndarray,
    size: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """|K_t| and |k_n| (n, 2), 1 / model unit^2, at uv (n, 2); zero where they are not known.

    along_first: (n,) bool, is t the first principal direction? size: (n,) a length.
    """
    if has_even_curvature(surface):
        return np.zeros((len(uv), 2))
    values, directions = np.stack([k.k1, k.k2], axis=1), np.stack([k.d1, k.d2], axis=1)
    rows, t = np.arange(len(uv)), np.where(along_first, 0, 1)
    step = STEP * size
    low, high = np.array(surface.domain).T
    rates = np.full((len(uv), 2), np.inf)
    for column, (axis, changing) in enumerate(((t, 1 - t), (1 - t, t))):
        for way in (1.0, -1.0):  # a node may lie on a knot, where curvatures jump
            there = uv + way * step[:, None] * directions[rows, axis]
            inside = ((there >= low) & (there <= high)).all(axis=1)
            with np.errstate(all="ignore"):
                around = _curvatures_at(surface, np.clip(there, low, high))
                rate = np.abs(around[rows, changing] - values[rows, changing]) / step
            rate[~inside] = np.inf
            rates[:, column] = np.fmin(rates[:, column], rate)
    return np.where(np.isfinite(rates), rates, 0.0)


def longest_along(
    rates: np.ndarray, k1: np.ndarray, k2: np.ndarray, size: np.ndarray, chord: float
) -> np.ndarray:
    """Largest length (n,) of triangles that are ``size`` (n,) wide; at least that."""
    fanning, bending = rates.T
    sag = np.maximum(np.abs(k1), np.abs(k2)) * size**2
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        spare = np.fmax(DECIDED * chord / sag, 1.0) ** 2
        sag = np.maximum(sag, SAG * chord) * spare
        bound = np.fmin(
            FANNING * sag / (fanning * size**2), np.sqrt(BENDING * sag / (bending * size))
        )
    bound[np.isnan(bound) | (size <= 2.0 * chord)] = np.inf  # such a triangle is within chord
    return np.fmax(bound, size)


def _curvatures_at(surface: Surface, uv: np.ndarray) -> np.ndarray:
    """Principal curvatures (n, 2) at uv, not a number where they are not known."""
    _, *derivatives = surface.evaluate(uv, 2)
    forms = forms_from_derivatives(*derivatives)
    k = curvatures(forms)
    found = np.stack([k.k1, k.k2], axis=1)
    found[forms.degenerate] = np.nan
    return found
