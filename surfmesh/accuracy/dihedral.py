"""Angles between neighbouring triangles, and which of them the surface makes.

A surface bends by itself at a crease where two of its sides meet, or at an apex: there
the angle is as large at any size.

              c                  half-edge e runs from a to b in a-b-c, half-edge f from b to a
             / \\                 in b-a-d: corners beside the edge are (a, b, c), (b, a, d)
            / e \\
           a --- b
            \\ f /
             \\ /
              d
"""

import math

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface
from surfmesh.kernels.optimisation import dihedral
from surfmesh.sizing.options.defaults import FINEST_BY_ANGLE
from surfmesh.sizing.rules.curvature_size import angle_size

SLACK = 1e-9
"""Relative: rounding in the angle itself."""

INSIDE = 1e-3
"""Normals are read so far inside the triangles, as a fraction of the way to the centroid: at an
apex there is none, and at a crease one for each side."""

CREASE = math.cos(math.radians(1.0))
"""Cosine of the angle between the normals on both sides from which there is a crease."""


def dihedral_angles(
    points: NDArray[np.float64], triangles: NDArray[np.int32], half_edges: NDArray[np.int32]
) -> NDArray[np.float64]:
    """Radians (k,) between the normals of the triangles at pairs of half-edges (k, 2)."""
    angles = np.empty(len(half_edges))
    dihedral.dihedral_angles(points, triangles, half_edges, angles)
    return angles


def corners_beside(half_edges: NDArray[np.integer]) -> NDArray[np.integer]:
    """Positions (k, 2, 3) in the list of all corners: the two ends of each edge, the far corner.

    half_edges: (k, 2), one in each of the two triangles.
    """
    triangle, side = np.divmod(half_edges, 3)
    return 3 * triangle[..., None] + (side[..., None] + [0, 1, 2]) % 3


def on_crease(
    surface: Surface,
    vertices: NDArray[np.integer],
    uv: NDArray[np.float64],
    angle: float,
    diagonal: float,
) -> NDArray[np.bool_]:
    """Which edges (k,) lie on a crease, at an apex, or as good as at one.

    vertices, uv: (k, 2, 3) and (k, 2, 3, 2) of the ``corners_beside`` each edge. As good as at
    an apex: curved so much that ``angle`` (degrees) would ask for less than ``FINEST_BY_ANGLE``
    of the diagonal, model units.
    """
    first, second = uv[:, 0], uv[:, 1].copy()
    alike = vertices[:, 0, 0] == vertices[:, 1, 0]  # both run the same way: a Moebius strip
    second[alike] = second[alike][:, [1, 0, 2]]
    corners = np.concatenate([first, second], axis=1)
    centre = np.repeat(np.stack([first.mean(axis=1), second.mean(axis=1)], axis=1), 3, axis=1)
    inside = corners + INSIDE * (centre - corners)
    _, ru, rv, *more = surface.evaluate(inside.reshape(-1, 2), 2)
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
    bent: NDArray[np.bool_] = sharp.reshape(-1, 6).any(axis=1) | (np.minimum(*same) < CREASE)
    return bent
