"""Edges that pass through triangles, and triangles folded onto their neighbours."""

import numpy as np
import shapely

CLEAR = 1e-9  # of a triangle's size: what is nearer to its plane touches, and is not judged
FOLDED = 1e-6  # sine between two neighbours that lie on each other


def piercing(points: np.ndarray, triangles: np.ndarray) -> int:
    """How many edges pass through the inside of a triangle that they share no corner with."""
    points = _of_ordinary_size(points)
    edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0)
    boxes = [(points[of].min(axis=1), points[of].max(axis=1)) for of in (edges, triangles)]
    flat = [shapely.box(*low[:, :2].T, *high[:, :2].T) for low, high in boxes]
    edge, near = shapely.STRtree(flat[1]).query(flat[0])
    (low, high), (bottom, top) = boxes
    close = (low[edge, 2] <= top[near, 2]) & (bottom[near, 2] <= high[edge, 2])
    close &= ~(triangles[near][:, :, None] == edges[edge][:, None, :]).any(axis=(1, 2))
    edge, near = edge[close], near[close]
    ends = points[edges[edge]]
    through = _passes(ends[:, 0], ends[:, 1], points[triangles[near]])
    return len(np.unique(edge[through]))


def _passes(p: np.ndarray, q: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(k,) do segments from p to q (k, 3) cross triangles (k, 3, 3), clear of rounding?"""
    a, b, c = np.moveaxis(corners, 1, 0)
    normal = np.cross(b - a, c - a)
    size = np.linalg.norm(normal, axis=1)
    above = np.einsum("ij,ij->i", normal, p - a), np.einsum("ij,ij->i", normal, q - a)
    small = CLEAR * size * np.sqrt(size)
    crosses = (np.minimum(*above) < -small) & (np.maximum(*above) > small)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = p + (above[0] / (above[0] - above[1]))[:, None] * (q - p)
    at[~crosses] = 0.0
    for one, other in ((a, b), (b, c), (c, a)):
        side = np.einsum("ij,ij->i", np.cross(other - one, at - one), normal)
        crosses = crosses & (side > 1e-7 * size**2)
    return crosses


def folded(points: np.ndarray, triangles: np.ndarray) -> int:
    """How many pairs of neighbours lie on the same side of their edge, in one plane."""
    points = _of_ordinary_size(points)
    starts, ends = triangles.ravel(), triangles[:, (1, 2, 0)].ravel()
    third = triangles[:, (2, 0, 1)].ravel()
    edges = np.sort(np.column_stack([starts, ends]), axis=1)
    order = np.lexsort(edges.T)
    twins = np.flatnonzero((edges[order[1:]] == edges[order[:-1]]).all(axis=1))
    i, j = order[twins], order[twins + 1]
    a, along = points[edges[i, 0]], points[edges[i, 1]] - points[edges[i, 0]]
    first, second = np.cross(along, points[third[i]] - a), np.cross(along, points[third[j]] - a)
    sizes = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    sine = np.linalg.norm(np.cross(first, second), axis=1)
    same = np.einsum("ij,ij->i", first, second) > 0.0
    return int((same & (sine < FOLDED * sizes)).sum())


def _of_ordinary_size(points: np.ndarray) -> np.ndarray:
    """Scaled by a power of two, that products neither overflow nor vanish."""
    return np.ldexp(points, -int(np.frexp(np.ptp(points, axis=0).max())[1]))
