"""Distances of points from triangles in space."""

import numpy as np
from numpy.typing import NDArray


def triangle_distances(points: NDArray, corners: NDArray) -> NDArray[np.float64]:
    """Distance (k,) of points (k, 3) from triangles with ``corners`` (k, 3, 3)."""
    a = corners[:, 0]
    ab, ac, ap = corners[:, 1] - a, corners[:, 2] - a, points - a
    bb, bc, cc = _dot(ab, ab), _dot(ab, ac), _dot(ac, ac)
    pb, pc = _dot(ap, ab), _dot(ap, ac)
    with np.errstate(divide="ignore", invalid="ignore"):
        det = bb * cc - bc * bc
        v, w = (cc * pb - bc * pc) / det, (bb * pc - bc * pb) / det
        inside = (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0)
        offset = ap - v[:, None] * ab - w[:, None] * ac
        distance = np.sqrt(_dot(offset, offset))
    out = np.flatnonzero(~inside)
    if len(out):
        ab, ac, ap = ab[out], ac[out], ap[out]
        ends = ((ap, ab), (ap, ac), (ap - ab, ac - ab))
        distance[out] = np.sqrt(np.minimum.reduce([_squared(*end) for end in ends]))
    return distance


def _squared(way: NDArray, side: NDArray) -> NDArray[np.float64]:
    """Squared distance (k,) of ``way`` (k, 3) from the segment from 0 to ``side`` (k, 3)."""
    t = np.clip(_dot(way, side) / np.maximum(_dot(side, side), np.finfo(float).tiny), 0.0, 1.0)
    offset = way - t[:, None] * side
    return _dot(offset, offset)


def _dot(a: NDArray, b: NDArray) -> NDArray[np.float64]:
    return np.einsum("ij,ij->i", a, b)
