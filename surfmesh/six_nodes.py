"""Triangles of six nodes: corners, and one node amid each edge, shared by its triangles.

              2
             / \\            corners 0 1 2, then the middles of 0-1, 1-2, 2-0: the order of
            5   4           VTK's quadratic triangle, Gmsh's type 9, Abaqus' STRI65, XDMF's
           /     \\          Triangle_6
          0 - 3 - 1
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh.connectivity import Connectivity, connect


def six_nodes(
    triangles: NDArray[np.int32], table: Connectivity, first: int
) -> NDArray[np.int32]:  # fmt: skip
    """(m, 6) nodes; the middle of edge number e is node ``first + e``."""
    rows = edge_rows(table, np.stack((triangles, triangles[:, (1, 2, 0)]), axis=-1).reshape(-1, 2))
    return np.hstack((triangles, first + rows.reshape(-1, 3))).astype(np.int32)


def edge_rows(table: Connectivity, pairs: NDArray) -> NDArray[np.int64]:
    """Rows of ``table.edges`` of the pairs (k, 2) of vertex numbers; -1 where there is none."""
    width = np.int64(max(int(table.edges.max(initial=0)), int(pairs.max(initial=0))) + 1)
    keys = table.edges.astype(np.int64) @ np.array([width, 1])  # ascending: see connect
    wanted = np.sort(pairs.astype(np.int64), axis=1) @ np.array([width, 1])
    rows = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[rows] == wanted, rows, -1)


def split_six_nodes(
    nodes: NDArray[np.float64], elements: NDArray
) -> tuple[NDArray[np.float64], NDArray, NDArray[np.float64], NDArray]:
    """points, triangles, mid_points by the edges of the triangles, and the nodes (n,) kept as
    points. elements: (m, 6).
    """
    corners, triangles = np.unique(elements[:, :3], return_inverse=True)
    triangles = triangles.reshape(-1, 3).astype(np.int32)
    first = connect(triangles).half_edges[:, 0]
    return nodes[corners], triangles, nodes[elements[:, 3:].reshape(-1)[first]], corners


def node_values(values: NDArray[np.float64], edges: NDArray) -> NDArray[np.float64]:
    """Values at the points (n, ...) and, after them, the means of the ends of each edge."""
    return np.concatenate((values, values[edges].mean(axis=1)))
