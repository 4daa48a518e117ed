"""Which points lie within a closed surface of triangles: crossings of a ray, counted.

Two rays in directions that no model is built along; both must find an odd number.
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.small_matrices import norm, product
from surfmesh.quality.measures.pairs_of_ranges import expanded

_DIRECTIONS = ((0.2831, 0.3947, 0.8741), (-0.6173, 0.5519, 0.5607))


def inside(points: NDArray[np.float64], corners: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(k,) which of points (k, 3) lie within triangles (m, 3, 3), however these are turned."""
    found = np.ones(len(points), bool)
    for direction in _DIRECTIONS:
        left = np.flatnonzero(found)
        if len(left):
            found[left] = _crossings(points[left], corners, np.array(direction)) % 2 == 1
    return found


def _crossings(points: NDArray, corners: NDArray, direction: NDArray) -> NDArray[np.int64]:
    """How often the ray from each point goes through triangles."""
    frame = _frame(direction)
    seen, at = product(corners, frame), product(points, frame)
    order = np.argsort(at[:, 0], kind="stable")
    low, high = seen.min(axis=1), seen.max(axis=1)
    first = np.searchsorted(at[order, 0], low[:, 0])
    last = np.searchsorted(at[order, 0], high[:, 0], side="right")
    triangle, place = expanded(first, last)
    point = order[place]
    near = (low[triangle, 1] <= at[point, 1]) & (at[point, 1] <= high[triangle, 1])
    near &= at[point, 2] <= high[triangle, 2]
    triangle, point = triangle[near], point[near]
    offset = seen[triangle] - at[point][:, None, :]
    a, b, c = offset.transpose(1, 0, 2)
    areas = np.stack([_cross(b, c), _cross(c, a), _cross(a, b)], axis=1)
    hit = (areas > 0).all(axis=1) | (areas < 0).all(axis=1)
    areas, offset = areas[hit], offset[hit]
    height = np.einsum("ij,ij->i", areas, offset[:, :, 2]) / areas.sum(axis=1)
    return np.bincount(point[hit][height > 0.0], minlength=len(points))


def _cross(a: NDArray, b: NDArray) -> NDArray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _frame(direction: NDArray) -> NDArray:
    """Columns: two axes across the direction, and itself."""
    z = direction / norm(direction)
    x = np.cross((0.0, 1.0, 0.0), z)
    x /= norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)
