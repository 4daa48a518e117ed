"""How long an edge may be along the direction of low curvature before that turns away from it.

Let t be the principal direction with the smaller curvature k, n the one with the larger K. By
the equations of Codazzi the lines of curvature along t bend within the surface at the rate
k_n / (K - k), and they fan out at the rate K_t / (K - k), where k_n is the derivative of k in
the direction n (do Carmo, 4-3). In the frame of one point the surface has the cubic terms

    k_t x^3 / 6 + k_n x^2 y / 2 + K_t x y^2 / 2,

to be compared with K y^2 / 2 over a triangle of length x and width y = h: none of them may be
large beside what the larger curvature takes of the chord.
"""

import os

import numpy as np

from surfmesh.geometry.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface

BENDING, FANNING, SWELLING = eval(os.environ.get("KEPT", "[.7,.36,4.]"))
"""Largest k_n L^2 / (K h), K_t L / K and k_t L^3 / (K h^2)."""

STEP = 0.02
"""In shorter sizes: the way over which curvatures are compared."""


def turning_bound(
    surface: Surface, uv: np.ndarray, k: np.ndarray, d: np.ndarray, size: np.ndarray,
    first: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Largest length (n,) along the direction of low curvature, at least ``size`` (n,).

    uv: (n, 2); k: (n, 2) principal curvatures, the larger number first; d: (n, 2, 2) their
    directions in (u, v), of unit length; size: (n,) the shorter one; first: (n,) bool, is the
    longer size along the first direction?
    """
    rows, longer = np.arange(len(uv)), np.where(first, 0, 1)
    step = STEP * size
    here = k[rows, longer], k[rows, 1 - longer]
    change = []
    for direction in (d[rows, longer], d[rows, 1 - longer]):
        there = _curvatures_at(surface, _inside(surface, uv, step[:, None] * direction))
        for mine, axis in zip(here, (longer, 1 - longer)):
            change.append(np.abs(there[rows, axis] - mine) / step)
    swelling, fanning, bending, _ = np.nan_to_num(change)
    large = np.abs(here[1])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        bound = np.minimum(FANNING * large / fanning, np.sqrt(BENDING * large * size / bending))
        bound = np.fmin(bound, np.cbrt(SWELLING * large * size * size / swelling))
    return np.fmax(np.nan_to_num(bound, nan=np.inf), size)


def _inside(surface: Surface, uv: np.ndarray, step: np.ndarray) -> np.ndarray:
    """A step (n, 2) from uv (n, 2), or the opposite one where it would leave the domain."""
    low, high = np.array(surface.domain).T
    there = uv + step
    outside = ((there < low) | (there > high)).any(axis=1)
    there[outside] = uv[outside] - step[outside]
    return np.clip(there, low, high)


def _curvatures_at(surface: Surface, uv: np.ndarray) -> np.ndarray:
    """Principal curvatures (n, 2) at uv, not a number where they are not known."""
    _, *derivatives = surface.evaluate(uv, 2)
    forms = forms_from_derivatives(*derivatives)
    k = curvatures(forms)
    found = np.stack([k.k1, k.k2], axis=1)
    found[forms.degenerate] = np.nan
    return found
