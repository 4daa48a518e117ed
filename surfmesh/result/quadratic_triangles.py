"""Triangles of six nodes: corners, and one node amid each edge, shared by its triangles.

    2
   / \\            corners 0 1 2, then the middles of 0-1, 1-2, 2-0: the order of
  5   4           VTK's quadratic triangle, Gmsh's type 9, Abaqus' STRI65, XDMF's
 /     \\          Triangle_6
0 - 3 - 1
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.small_matrices import product
from surfmesh.result.connectivity import Connectivity, connect

# Derivatives of the six functions by s and t of (r, s, t), r = 1 - s - t, at the three corners.
# Functions: r (2r-1), s (2s-1), t (2t-1), 4rs, 4st, 4tr.
_ALONG_S = np.array([(-3, -1, 0, 4, 0, 0), (1, 3, 0, -4, 0, 0), (1, -1, 0, 0, 4, -4)], float)
_ALONG_T = np.array([(-3, 0, -1, 0, 0, 4), (1, 0, -1, -4, 4, 0), (1, 0, 3, 0, 0, -4)], float)


def six_nodes(
    triangles: NDArray[np.int32], table: Connectivity, first: int
) -> NDArray[np.int32]:  # fmt: skip
    """(m, 6) nodes; the middle of edge number e is node ``first + e``."""
    rows = edge_rows(table, np.stack((triangles, triangles[:, (1, 2, 0)]), axis=-1).reshape(-1, 2))
    return np.hstack((triangles, first + rows.reshape(-1, 3))).astype(np.int32)


def edge_rows(table: Connectivity, pairs: NDArray) -> NDArray[np.int64]:
    """Rows of ``table.edges`` of the pairs (k, 2) of vertex numbers; -1 where there is none."""
    from surfmesh._core import space  # late, as in ``connect``

    return space.edge_rows(table.edges, np.ascontiguousarray(pairs, np.int32))


def split_six_nodes(
    nodes: NDArray[np.float64], elements: NDArray
) -> tuple[NDArray[np.float64], NDArray, NDArray[np.float64], NDArray]:
    """points, triangles, mid_points by the edges of the triangles, and the nodes (n,) kept as
    points. elements: (m, 6).
    """
    corners, inverse = np.unique(elements[:, :3], return_inverse=True)
    triangles: NDArray[np.int32] = inverse.reshape(-1, 3).astype(np.int32)
    first = connect(triangles).half_edges[:, 0]
    return nodes[corners], triangles, nodes[elements[:, 3:].reshape(-1)[first]], corners


def node_values(values: NDArray[np.float64], edges: NDArray) -> NDArray[np.float64]:
    """Values at the points (n, ...) and, after them, the means of the ends of each edge."""
    return np.concatenate((values, values[edges].mean(axis=1)))


def derivatives(
    nodes: NDArray[np.float64], weights: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Derivatives (m, q, 3) by s and by t, and points, at weights (q, 3) of nodes (m, 6, 3)."""
    r, s, t = weights.T
    corners = weights * (2.0 * weights - 1.0)
    functions = np.column_stack([corners, 4.0 * r * s, 4.0 * s * t, 4.0 * t * r])
    found = (np.einsum("qk,mkd->mqd", rows, nodes) for rows in (
        product(weights, _ALONG_S), product(weights, _ALONG_T), functions,
    ))  # fmt: skip
    along_s, along_t, points = found
    return along_s, along_t, points


def least_jacobians(nodes: NDArray[np.float64], elements: NDArray) -> NDArray[np.float64]:
    """(m,) below the Jacobian of each six-node triangle, seen along the normal of its corners.

    1 for straight edges with their nodes in the middle; positive: the map of the triangle is one
    to one as seen from there. The Jacobian is a quadratic polynomial; no value of it lies below
    the least of its Bezier coefficients.
    Source: A. Johnen, J.-F. Remacle, C. Geuzaine, "Geometrical validity of curvilinear finite
    elements", J. Comput. Phys. 233 (2013), section 2.
    """
    m = len(elements)
    x = nodes[elements.T]  # (6, m, 3)
    normal = np.cross(x[1] - x[0], x[2] - x[0])
    squared = np.einsum("ij,ij->i", normal, normal)
    normal /= np.where(squared > 0.0, squared, 1.0)[:, None]
    # the derivatives are linear: their values at the corners say all
    along_s, along_t = (
        product(corners, x.reshape(6, -1)).reshape(3, m, 3) for corners in (_ALONG_S, _ALONG_T)
    )
    least = np.full(m, np.inf)
    for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)):
        area = np.cross(along_s[a], along_t[b])
        if a != b:
            area = 0.5 * (area + np.cross(along_s[b], along_t[a]))
        np.minimum(least, np.einsum("ij,ij->i", area, normal), out=least)
    return least
