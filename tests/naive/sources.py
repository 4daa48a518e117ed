"""Sizes that grow from sources: all sources at all points."""

import numpy as np


def graded_sizes(
    xy: np.ndarray,
    place: np.ndarray,
    size: np.ndarray,
    largest: float,
    slope: float,
    metric: tuple[float, float, float] = (1.0, 0.0, 1.0),
) -> np.ndarray:
    """min(largest, h_k + slope d_k) at xy (m, 2), for sources at ``place`` (n, 2)."""
    E, F, G = metric
    out = np.full(len(xy), float(largest))
    for (x, y), h in zip(place, size):
        dx, dy = xy[:, 0] - x, xy[:, 1] - y
        out = np.minimum(out, h + slope * np.sqrt(E * dx**2 + 2 * F * dx * dy + G * dy**2))
    return out


def leaves(background) -> np.ndarray:
    """x, y, width, height, cell (leaves, 5) of all leaves, from the roots down."""
    nx, ny = background.grid
    x0, y0, across, up = background.box[:4]
    found = []
    todo = [
        (x0 + i / across, y0 + j / up, 1 / across, 1 / up, j * nx + i)
        for j in range(ny)
        for i in range(nx)
    ]
    while todo:
        x, y, wide, high, cell = todo.pop()
        first = background.child[cell]
        if first < 0:
            found.append((x, y, wide, high, cell))
            continue
        for k in range(4):
            dx, dy = 0.5 * wide * (k % 2), 0.5 * high * (k // 2)
            todo.append((x + dx, y + dy, 0.5 * wide, 0.5 * high, first + k))
    return np.array(found)


def is_balanced(found: np.ndarray) -> bool:
    """No leaf of ``leaves`` has a neighbour across a side that is more than twice as wide."""
    x, y, wide, high = found[:, :4].T
    for a in range(0, len(found), 200):
        few = slice(a, a + 200)
        thin = 1e-6 * wide[few, None]
        left, right = x[few, None] - thin, (x + wide)[few, None] + thin
        low, up = y[few, None] - thin, (y + high)[few, None] + thin
        in_x = (x + wide > x[few, None] + thin) & (x < (x + wide)[few, None] - thin)
        in_y = (y + high > y[few, None] + thin) & (y < (y + high)[few, None] - thin)
        beside = in_y & (x < right) & (x + wide > left) | in_x & (y < up) & (y + high > low)
        if (np.where(beside, wide, 0.0) > 2.000001 * wide[few, None]).any():
            return False
    return True
