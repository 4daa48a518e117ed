"""Is the map of a curved tetrahedron one to one? Its Jacobian by Bezier coefficients.

The derivatives of the ten functions are linear, so that the determinant is a cubic polynomial; no
value of it lies below the least of its 20 coefficients.
Source: A. Johnen, J.-F. Remacle, C. Geuzaine, "Geometrical validity of curvilinear finite
elements", J. Comput. Phys. 233 (2013), section 2.
"""

from itertools import combinations_with_replacement, permutations

import numpy as np
from numpy.typing import NDArray

MIDDLE = np.array([(0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3)])
"""The node amid corners i and j; on the diagonal the corner itself."""


def least_jacobians(nodes: NDArray[np.float64], elements: NDArray) -> NDArray[np.float64]:
    """(k,) below the Jacobian of each ten-node tetrahedron, over that of its straight corners.

    1 for straight edges with their nodes in the middle; positive: the map is one to one.
    """
    # half the derivative by the weight of corner i, at corner j: the control point of edge i-j
    control = np.empty((4, 4, len(elements), 3))
    for i in range(4):
        for j in range(4):
            own, other = (nodes[elements[:, at]] for at in (i, j))
            middle = nodes[elements[:, MIDDLE[i, j]]]
            control[i, j] = own if i == j else 2.0 * middle - 0.5 * (own + other)
    along = control[1:] - control[0]  # (3, 4, k, 3): along the edges from corner 0, at each corner
    straight = _determinant(*(nodes[elements[:, i]] - nodes[elements[:, 0]] for i in (1, 2, 3)))
    least = np.full(len(elements), np.inf)
    for corners in combinations_with_replacement(range(4), 3):
        orders = list(permutations(corners))
        total = sum(_determinant(along[0, a], along[1, b], along[2, c]) for a, b, c in orders)
        np.minimum(least, 8.0 * total / len(orders), out=least)
    return least / straight


def _determinant(a: NDArray, b: NDArray, c: NDArray) -> NDArray:
    return np.einsum("ij,ij->i", np.cross(a, b), c)
