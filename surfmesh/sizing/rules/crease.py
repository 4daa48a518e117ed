"""Where a surface bends by itself, so that triangles turn by as much at any size."""

import math

import numpy as np

from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.options.defaults import FINEST_BY_ANGLE
from surfmesh.sizing.rules.curvature_size import angle_size

INSIDE = 1e-3
"""Normals are read so far inside the triangles, as a share of the way to the centroid: at an
apex there is none, and at a crease one for each side."""

CREASE = math.cos(math.radians(1.0))
"""Cosine of the angle between the normals on both sides from which there is a crease."""


def on_crease(
    surface: Surface, first: np.ndarray, second: np.ndarray, angle: float, diagonal: float
) -> np.ndarray:
    """Is the edge between two triangles on a crease, at an apex, or as good as at one? (k,) bool.

    first, second: (k, 3, 2) parameters of the corners; the edge runs from corner 0 to 1 of the
    first and from 1 to 0 of the second. As good as at an apex: curved so much that ``angle``
    (degrees) would ask for less than ``FINEST_BY_ANGLE`` of the diagonal.
    """
    corners = np.concatenate([first, second], axis=1)
    centre = np.repeat(np.stack([first.mean(axis=1), second.mean(axis=1)], axis=1), 3, axis=1)
    uv = corners + INSIDE * (centre - corners)
    _, ru, rv, *more = surface.evaluate(uv.reshape(-1, 2), 2)
    forms = forms_from_derivatives(ru, rv, *more)
    k = curvatures(forms)
    with np.errstate(invalid="ignore"):
        size = angle_size(k.k1, k.k2, angle)
    known = ~forms.degenerate & np.isfinite(forms.normal).all(axis=1)
    sharp = ~known | (size < FINEST_BY_ANGLE * diagonal)
    n = forms.normal.reshape(-1, 6, 3)
    # the sign depends on the parametrisation, which may turn over at a seam, not within
    within = (first[:, [0, 1]] == second[:, [1, 0]]).all(axis=(1, 2))
    same = [np.einsum("ij,ij->i", n[:, i], n[:, j]) for i, j in ((0, 4), (1, 3))]
    same = [np.where(within, cosine, np.abs(cosine)) for cosine in same]
    return sharp.reshape(-1, 6).any(axis=1) | (np.minimum(*same) < CREASE)
