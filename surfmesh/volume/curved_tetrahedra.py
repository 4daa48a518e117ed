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


def _edge_vectors() -> NDArray[np.float64]:
    """(3, 4, 10) weights of the nodes in half the derivatives along the edges from corner 0, at
    each corner."""
    control = np.zeros((4, 4, 10))  # of the function of corner i, at corner j
    for i in range(4):
        for j in range(4):
            if i == j:
                control[i, j, i] = 1.0
            else:  # the control point of edge i-j
                control[i, j, MIDDLE[i, j]] = 2.0
                control[i, j, [i, j]] = -0.5
    return control[1:] - control[0]


def _products() -> NDArray[np.float64]:
    """(20, 64) the coefficients as means of determinants of three vectors, at corners i, j, k."""
    rows = []
    for corners in combinations_with_replacement(range(4), 3):
        row = np.zeros((4, 4, 4))
        orders = list(permutations(corners))
        for order in orders:
            row[order] += 8.0 / len(orders)
        rows.append(row.ravel())
    return np.array(rows)


EDGE_VECTORS, PRODUCTS = _edge_vectors(), _products()


def jacobians(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, 20) Bezier coefficients of the determinants of tetrahedra of ten nodes (k, 10, 3)."""
    along = np.einsum("ejn,tnd->tejd", EDGE_VECTORS, places)
    return _determinants(along) @ PRODUCTS.T


def gradients(places: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, 10, 3) derivatives by the nodes of the coefficients' sum with ``weights`` (k, 20)."""
    along = np.einsum("ejn,tnd->tejd", EDGE_VECTORS, places)
    a, b, c = along[:, 0], along[:, 1], along[:, 2]
    of = (weights @ PRODUCTS).reshape(-1, 4, 4, 4)
    slopes = np.empty_like(along)
    slopes[:, 0] = np.einsum("tijk,tjkd->tid", of, _crosses(b, c))
    slopes[:, 1] = np.einsum("tijk,tkid->tjd", of, _crosses(c, a))
    slopes[:, 2] = np.einsum("tijk,tijd->tkd", of, _crosses(a, b))
    return np.einsum("ejn,tejd->tnd", EDGE_VECTORS, slopes)


def straight_jacobians(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) determinants of the straight tetrahedra of the corners."""
    a, b, c, d = (places[:, i] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)


def least_jacobians(nodes: NDArray[np.float64], elements: NDArray) -> NDArray[np.float64]:
    """(k,) below the Jacobian of each ten-node tetrahedron, over that of its straight corners.

    1 for straight edges with their nodes in the middle; positive: the map is one to one.
    """
    places = nodes[elements]
    straight = np.maximum(np.abs(straight_jacobians(places)), np.finfo(float).tiny)
    return jacobians(places).min(axis=1, initial=np.inf) / straight


def _determinants(along: NDArray) -> NDArray:
    """(k, 64) of the vectors at corners i, j, k."""
    found = np.einsum("tid,tjkd->tijk", along[:, 0], _crosses(along[:, 1], along[:, 2]))
    return found.reshape(-1, 64)


def _crosses(a: NDArray, b: NDArray) -> NDArray:
    return np.cross(a[:, :, None, :], b[:, None, :, :])
