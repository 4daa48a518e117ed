"""Angles between neighbouring triangles.

A surface bends by itself at a crease where two of its sides meet, or at an apex: there
the angle is as large at any size (``src/patch/creases.hpp``).

              c                  half-edge e runs from a to b in a-b-c, half-edge f from b to a
             / \\                 in b-a-d
            / e \\
           a --- b
            \\ f /
             \\ /
              d
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import optimisation

SLACK = 1e-9
"""Relative: rounding in the angle itself."""


def dihedral_angles(
    points: NDArray[np.float64], triangles: NDArray[np.int32], half_edges: NDArray[np.int32]
) -> NDArray[np.float64]:
    """Radians (k,) between the normals of the triangles at pairs of half-edges (k, 2)."""
    return optimisation.dihedral_angles(points, triangles, half_edges)
