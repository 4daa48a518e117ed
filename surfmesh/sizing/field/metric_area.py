"""The metric area within loops: how many triangles a size field asks for there.

The leaves of the background are integrated by two by two points of Gauss. Those on a loop are
split first, until a part is as small as the triangles there.
"""

from collections.abc import Sequence

import numpy as np

from surfmesh._core.fields import Background
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.sizing.field.size_field import SizeField

TRIANGLES = 4.0 / np.sqrt(3.0)
"""Unit triangles on a unit of metric area."""

FINEST = 1.5
"""In edges: parts of cells on a loop that are no larger are not split."""

LONGEST = 2.0
"""In edges: segments of loops are halved until they are no longer."""

MOST_PARTS, MOST_HALVINGS = 2_000_000, 20
_GAUSS = 0.5 - 0.5 / np.sqrt(3.0)


def metric_area(field: SizeField, loops: Sequence[np.ndarray] | None = None) -> float:
    """Integral of 1 / det H over the field's rectangle, or over what lies within loops in it.

    loops: (k, 2) points in (u, v), not closed; inside by even-odd.
    """
    low, step = _leaves(field.background)
    extent = field.chart.extent
    high = np.minimum(low + step, extent)
    step = high - low
    there = (step > 0.0).all(axis=1)
    low, step = low[there], step[there]
    if loops is None:
        return float(_integrals(field, low, step).sum())
    from scipy.spatial import cKDTree

    rings = [field.chart.to_plane(loop) for loop in loops]
    nodes, first = _dense(field, rings)
    spacing = _spacing(nodes, first)
    tree = cKDTree(nodes)
    total = 0.0
    while len(low):
        middle = low + 0.5 * step
        # a loop is within reach of a cell if one of its nodes is, or half a segment farther
        distance, near = tree.query(middle, k=[*range(1, 1 + min(3, len(nodes)))])
        away = (distance - 0.5 * spacing[near]).min(axis=1)
        crossed = away <= 0.5 * np.linalg.norm(step, axis=1)
        total += _integrals(field, low[~crossed], step[~crossed])[
            is_inside(rings, middle[~crossed])
        ].sum()
        low, step, middle = low[crossed], step[crossed], middle[crossed]
        tensors = field.tensors(middle)
        across = step / np.maximum(tensors[:, [0, 2]], np.finfo(float).tiny)
        small = (across.max(axis=1) <= FINEST) | (len(low) > MOST_PARTS)
        total += _shares(field, rings, low[small], step[small])
        low, step = _quartered(low[~small], step[~small], across[~small])
    return total


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
    low, step = _leaves(field.background)
    step = np.minimum(low + step, field.chart.extent) - low
    there = (step > 0.0).all(axis=1)
    if rings is not None:
        there &= is_inside(rings, low + 0.5 * step)
    low, step = low[there], step[there]
    return low, step, _integrals(field, low, step)


def _leaves(background: Background) -> tuple[np.ndarray, np.ndarray]:
    """Lower left corners (n, 2) and sides (n, 2) of all leaves."""
    nx, ny = (int(n) for n in background.grid)
    cell = np.arange(nx * ny)
    step = 1.0 / background.box[2:4]
    low = background.box[:2] + np.stack([cell % nx, cell // nx], axis=1) * step
    lows, steps = [], []
    while len(cell):
        first = background.child[cell]
        leaf = first < 0
        lows.append(low[leaf])
        steps.append(np.tile(step, (int(leaf.sum()), 1)))
        step = 0.5 * step
        quarter = np.array([[0, 0], [1, 0], [0, 1], [1, 1]]) * step
        low = (low[~leaf][:, None] + quarter).reshape(-1, 2)
        cell = (first[~leaf][:, None] + np.arange(4)).ravel()
    return np.concatenate(lows), np.concatenate(steps)


def _points(low: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Two by two points of Gauss in each cell (n, 4, 2)."""
    at = np.array([_GAUSS, 1.0 - _GAUSS])
    share = np.stack(np.meshgrid(at, at), axis=-1).reshape(-1, 2)
    return low[:, None] + share * step[:, None]


def _densities(field: SizeField, points: np.ndarray) -> np.ndarray:
    """1 / det H at points (n, 4, 2): (n, 4)."""
    tensors = field.tensors(points.reshape(-1, 2))
    det = tensors[:, 0] * tensors[:, 2] - tensors[:, 1] ** 2
    return (1.0 / np.maximum(det, np.finfo(float).tiny)).reshape(-1, 4)


def _integrals(field: SizeField, low: np.ndarray, step: np.ndarray) -> np.ndarray:
    """(n,) over whole cells."""
    if not len(low):
        return np.empty(0)
    return _densities(field, _points(low, step)).mean(axis=1) * step.prod(axis=1)


def _shares(field: SizeField, rings: list[np.ndarray], low: np.ndarray, step: np.ndarray) -> float:
    """Over what lies inside of small cells, by their points."""
    if not len(low):
        return 0.0
    points = _points(low, step)
    inside = is_inside(rings, points.reshape(-1, 2)).reshape(-1, 4)
    values = np.where(inside, _densities(field, points), 0.0)
    return float((values.mean(axis=1) * step.prod(axis=1)).sum())


def _quartered(
    low: np.ndarray, step: np.ndarray, across: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Cells halved each way; long ones only along their longer side."""
    long = across > FINEST
    parts = []
    for mask, splits in ((long.all(axis=1), (2, 2)), (long[:, 0] & ~long[:, 1], (2, 1)),
                         (~long[:, 0] & long[:, 1], (1, 2))):  # fmt: skip
        for i in range(splits[0]):
            for j in range(splits[1]):
                part = step[mask] / splits
                parts.append((low[mask] + part * [i, j], part))
    return np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])


def _dense(field: SizeField, rings: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (n, 2) of the rings, with more points, so that no segment is much longer than a
    triangle there; and where those of each begin (k + 1,)."""
    nodes = np.concatenate(rings)
    first = np.cumsum([0, *map(len, rings)])
    for _ in range(MOST_HALVINGS):
        step = nodes[_following(first)] - nodes
        middle = nodes + 0.5 * step
        h = field.tensors(middle)
        across = np.abs(step) / np.maximum(h[:, [0, 2]], np.finfo(float).tiny)
        few = np.repeat(np.diff(first) <= MOST_PARTS, np.diff(first))
        long = np.flatnonzero((across.max(axis=1) > LONGEST) & few)
        if not len(long):
            break
        nodes = np.insert(nodes, long + 1, middle[long], axis=0)
        first = first + np.searchsorted(long, first)
    return nodes, first


def _following(first: np.ndarray) -> np.ndarray:
    """The node after each in its closed ring: (n,); of ring k those from first[k] on."""
    following = np.arange(1, first[-1] + 1)
    there = first[1:] > first[:-1]
    following[first[1:][there] - 1] = first[:-1][there]
    return following


def _spacing(nodes: np.ndarray, first: np.ndarray) -> np.ndarray:
    """The longer of the two segments at each node of closed rings."""
    following = _following(first)
    step = np.linalg.norm(nodes[following] - nodes, axis=1)
    longer = step.copy()
    longer[following] = np.maximum(step[following], step)
    return longer
