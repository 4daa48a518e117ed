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

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import optimisation, patch
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface

SLACK = 1e-9
"""Relative: rounding in the angle itself."""


def dihedral_angles(
    points: NDArray[np.float64], triangles: NDArray[np.int32], half_edges: NDArray[np.int32]
) -> NDArray[np.float64]:
    """Radians (k,) between the normals of the triangles at pairs of half-edges (k, 2)."""
    return optimisation.dihedral_angles(points, triangles, half_edges)


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
    (see ``sizing``) of the diagonal, model units.
    """
    alike = vertices[:, 0, 0] == vertices[:, 1, 0]  # both run the same way: a Moebius strip
    bent: NDArray[np.bool_] = patch.on_crease(
        as_core_surface(surface), np.ascontiguousarray(uv), alike.view(np.uint8), angle, diagonal
    ).astype(bool)
    return bent
