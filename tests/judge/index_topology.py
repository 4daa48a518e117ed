"""Topology of a triangle mesh by its indices alone."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


def faults_of_indices(
    points: np.ndarray, triangles: np.ndarray, *, closed: bool = False, oriented: bool = True
) -> list[str]:
    """What is wrong with the indices of a mesh that shall be a surface with or without border.

    Each edge has two triangles, or one on a border, and runs once each way; the triangles at a
    vertex are one fan; no point is left over, and no two are at one place.
    """
    if not len(triangles):
        return ["no triangles"]
    if triangles.min() < 0 or triangles.max() >= len(points):
        return ["triangles of points that do not exist"]
    faults = []
    a, b, c = triangles.T
    if ((a == b) | (b == c) | (c == a)).any():
        faults.append("triangles with a corner twice")
    if len(np.unique(np.sort(triangles, axis=1), axis=0)) < len(triangles):
        faults.append("triangles that are there twice")
    faults += _faults_of_edges(triangles, len(points), closed, oriented)
    pinched = int((fans(points, triangles) > 1).sum())
    if pinched:
        faults.append(f"{pinched} vertices of several fans")
    if len(np.unique(triangles)) < len(points):
        faults.append("points of no triangle")
    if len(np.unique(points, axis=0)) < len(points):
        faults.append("points at one place")
    return faults


def _faults_of_edges(triangles: np.ndarray, count: int, closed: bool, oriented: bool) -> list[str]:
    faults = []
    starts, ends = triangles.ravel(), triangles[:, (1, 2, 0)].ravel()
    wide = np.int64(count)
    times = np.unique(starts * wide + ends, return_counts=True)[1]
    if oriented and (times > 1).any():
        faults.append(f"{int((times > 1).sum())} edges run twice one way")
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    _, sharers = np.unique(low * wide + high, return_counts=True)
    if (sharers > 2).any():
        faults.append(f"{int((sharers > 2).sum())} edges of three or more triangles")
    if closed and (sharers == 1).any():
        faults.append(f"{int((sharers == 1).sum())} edges without a partner")
    return faults


def fans(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n,) connected components, through common edges, of the triangles at each vertex."""
    corners = triangles.ravel()
    after, before = np.roll(triangles, -1, 1).ravel(), np.roll(triangles, 1, 1).ravel()
    # one node a corner of a triangle; two are joined where they have an edge at the vertex
    owner = np.concatenate([corners, corners]).astype(np.int64)
    other = np.concatenate([after, before])
    node = np.tile(np.arange(len(corners)), 2)
    key = owner * np.int64(len(points)) + other
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(np.diff(key[order]) == 0)
    rows, columns = node[order[same]], node[order[same + 1]]
    size = len(corners)
    graph = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(size, size))
    _, label = connected_components(graph, directed=False)
    pairs = np.unique(np.column_stack([corners, label]), axis=0)
    return np.bincount(pairs[:, 0], minlength=len(points))


def euler_number(triangles: np.ndarray) -> int:
    """V - E + F."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return len(np.unique(triangles)) - len(np.unique(edges, axis=0)) + len(triangles)


def pieces(triangles: np.ndarray) -> int:
    """How many parts share no vertex."""
    count = int(triangles.max()) + 1
    rows, columns = triangles.ravel(), triangles[:, (1, 2, 0)].ravel()
    graph = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    return len(np.unique(label[np.unique(triangles)]))


def border_edges(triangles: np.ndarray) -> np.ndarray:
    """(k, 2) edges of one triangle."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    found, times = np.unique(edges, axis=0, return_counts=True)
    return found[times == 1]


def border_loops(triangles: np.ndarray) -> int:
    """How many connected borders."""
    edges = border_edges(triangles)
    if not len(edges):
        return 0
    names, numbers = np.unique(edges, return_inverse=True)
    rows, columns = numbers.reshape(-1, 2).T
    graph = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(len(names), len(names)))
    return connected_components(graph, directed=False)[0]
