"""The exact distance to a set of segments in space; a point is a segment without length."""

from __future__ import annotations

import numpy as np

from surfmesh._core.triangulation import BLOCK, distances

CELLS = 10  # bits each way of the grid along whose Z-curve segments are sorted


class SegmentDistance:
    """Distances to segments, sorted into blocks with bounding boxes. Immutable.

    starts, ends: (s, 3) float, at least one row, finite.
    """

    def __init__(self, starts: np.ndarray, ends: np.ndarray) -> None:
        segments = np.concatenate([starts, ends], axis=1)[_z_order(0.5 * (starts + ends))]
        ends = segments.reshape(-1, 2, 3)
        self._segments = np.ascontiguousarray(segments)
        self._boxes = _bounds(np.concatenate([ends.min(axis=1), ends.max(axis=1)], axis=1))
        self._groups = _bounds(self._boxes)

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) float -> (n,): distance of each point to the nearest segment."""
        points = np.asarray(points, dtype=float)
        if not len(points):
            return np.empty(0)
        order = _z_order(points)  # what is nearest to a point bounds the search of the next
        out = np.empty(len(points))
        out[order] = distances(points[order], self._segments, self._boxes, self._groups)
        return out


def _bounds(boxes: np.ndarray) -> np.ndarray:
    """Boxes (ceil(b / BLOCK), 6) around BLOCK boxes (b, 6) in a row each."""
    first = np.arange(0, len(boxes), BLOCK)
    low = np.minimum.reduceat(boxes[:, :3], first)
    return np.concatenate([low, np.maximum.reduceat(boxes[:, 3:], first)], axis=1)


def _z_order(points: np.ndarray) -> np.ndarray:
    """An order in which neighbours in space are mostly neighbours in the row (Morton)."""
    low, extent = points.min(axis=0), np.ptp(points, axis=0).max()
    cells = 2**CELLS - 1
    grid = ((points - low) * (cells / extent if extent > 0.0 else 0.0)).astype(np.int64)
    code = np.zeros(len(points), np.int64)
    for bit in range(CELLS):
        for axis in range(3):
            code |= ((grid[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")
