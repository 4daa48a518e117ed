"""Gradation of the edges of a CAD model where sizes depend on the direction.

Along an edge sizes grow as everywhere. At a vertex they do not pass from edge to edge as they
are: the seam of a tube is cut far more coarsely than the circle it ends on. What faces between
them get is a metric that fits both: edges of one line are as coarse as each other, edges at
right angles may differ by the largest ratio.
"""

import numpy as np

from surfmesh.geometry.small_matrices import product
from surfmesh.meshing.edges.polygon_lengths import lengths_along

ROUNDS = 10
"""How often what vertices pass on is passed on again, at most."""

RIGHT_ANGLE = 1e-9
"""Cosines are not taken to be smaller."""


def graded_by_direction(
    points: list[np.ndarray],
    target_sizes: list[np.ndarray],
    ways: np.ndarray,
    ends: np.ndarray,
    slope: float,
    ratio: float,
) -> list[np.ndarray]:
    """Graded sizes along each edge.

    points (n, 3), target_sizes (n,) at the samples of each edge; ways (e, 2, 3): unit tangents at
    its start and end; ends (e, 2): vertices. Of two edges at a vertex, one is at most ``ratio``
    times coarser, and at most 1 / cos of the angle between their lines: a size along one of them
    is a size along its part on the other too.
    """
    way = [lengths_along(place) for place in points]
    sizes = [_graded(size, step, slope) for size, step in zip(target_sizes, way)]
    vertex = np.asarray(ends).reshape(-1)
    order = np.argsort(vertex, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(vertex[order]) != 0])
    meetings = [group for group in np.split(order, starts[1:]) if len(group) > 1]
    tangent = np.asarray(ways).reshape(-1, 3)
    most_times = []  # (k, k) for each meeting: how much coarser the second may be than the first
    for group in meetings:
        cosine = np.abs(product(tangent[group], tangent[group].T))
        times = np.minimum(ratio, 1.0 / np.maximum(cosine, RIGHT_ANGLE))
        most_times.append(np.maximum(times, 1.0))
    for _ in range(ROUNDS):
        lowered = set()
        for group, times in zip(meetings, most_times):
            now = np.array([sizes[k // 2][-(k % 2)] for k in group])
            most = (now[:, None] * times).min(axis=0)
            for k, before, after in zip(group.tolist(), now, most):
                if after < 0.999 * before:
                    sizes[k // 2][-(k % 2)] = after
                    lowered.add(k // 2)
        for edge in lowered:
            sizes[edge] = _graded(sizes[edge], way[edge], slope)
        if not lowered:
            break
    return sizes


def _graded(size: np.ndarray, way: np.ndarray, slope: float) -> np.ndarray:
    """min over j of size_j + slope |way - way_j|, in one sweep each way."""
    rising = np.minimum.accumulate(size - slope * way) + slope * way
    falling = np.minimum.accumulate((size + slope * way)[::-1])[::-1] - slope * way
    return np.minimum(rising, falling)
