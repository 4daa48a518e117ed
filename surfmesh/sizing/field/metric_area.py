"""The metric area within loops: how many triangles a size field asks for there.

Within loops the core integrates; boxes and single leaves are integrated here by two by two points
of Gauss.
"""

from collections.abc import Sequence

import numpy as np

from surfmesh.geometry.inside_loops import is_inside
from surfmesh.sizing.field.size_field import SizeField

TRIANGLES = 4.0 / np.sqrt(3.0)
"""Unit triangles on a unit of metric area."""

_GAUSS = 0.5 - 0.5 / np.sqrt(3.0)


def metric_area(field: SizeField, loops: Sequence[np.ndarray] | None = None) -> float:
    """Integral of 1 / det H over the field's rectangle, or over what lies within loops in it.

    loops: (k, 2) points in (u, v), not closed; inside by even-odd.
    """
    if loops is None:
        return field.background.metric_area(*field.chart.extent.tolist())
    corners = field.chart.to_plane(np.concatenate([np.empty((0, 2)), *loops]))
    return field.background.metric_area_within(corners, np.cumsum([0, *map(len, loops)]))


def box_area(field: SizeField, box: np.ndarray, parts: int = 24) -> float:
    """The same over a box (x0, y0, x1, y1) of the scaled plane, in parts x parts cells."""
    step = (box[2:] - box[:2]) / parts
    at = np.arange(parts)
    low = box[:2] + np.stack(np.meshgrid(at, at), axis=-1).reshape(-1, 2) * step
    return float(_integrals(field, low, np.tile(step, (len(low), 1))).sum())


def inner_cells(
    field: SizeField, rings: Sequence[np.ndarray] | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lower left corners (n, 2), sides (n, 2) and metric areas (n,) of leaves with their middle
    inside ``rings`` (k, 2), in the scaled plane."""
    low, step, area = field.background.leaf_areas(*field.chart.extent.tolist())
    if rings is None:
        return low, step, area
    there = is_inside(rings, low + 0.5 * step)
    return low[there], step[there], area[there]


def _points(low: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Two by two points of Gauss in each cell (n, 4, 2)."""
    at = np.array([_GAUSS, 1.0 - _GAUSS])
    fraction = np.stack(np.meshgrid(at, at), axis=-1).reshape(-1, 2)
    return low[:, None] + fraction * step[:, None]


def _densities(field: SizeField, points: np.ndarray) -> np.ndarray:
    """1 / det H at points (n, 4, 2): (n, 4)."""
    tensors = field.tensors(points.reshape(-1, 2))
    det = tensors[:, 0] * tensors[:, 2] - tensors[:, 1] ** 2
    return (1.0 / np.maximum(det, np.finfo(float).tiny)).reshape(-1, 4)


def _integrals(field: SizeField, low: np.ndarray, step: np.ndarray) -> np.ndarray:
    """(n,) over whole cells."""
    return _densities(field, _points(low, step)).mean(axis=1) * step.prod(axis=1)
