"""Points of quadratic triangles and of their sides, and how far these lie from what they stand for.

    2
   / \\            corners 0 1 2, then the middles of 0-1, 1-2, 2-0
  5   4
 /     \\
0 - 3 - 1
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.deviation import STEPS, nearest_deviations
from surfmesh.geometry.surface import Surface

BLOCK = 1 << 15  # samples looked at together
CURVE_STEPS = 6  # of the projection to a curve, which starts well

_GRID = 8
WITHIN = np.array(
    [
        (i, j, _GRID - i - j)
        for i in range(_GRID + 1)
        for j in range(_GRID + 1 - i)
        if (2 * i % _GRID, 2 * j % _GRID) != (0, 0)
    ]
) / float(_GRID)
"""Barycentric places (39, 3) at which curved triangles are looked at: the error has several hills
in each; at the nodes, which are left out, it is nought."""
SLIGHT = 0.3
"""Of the chord: where the sides of a triangle bend by less, it is not worth a look: neither its
curved shape nor its straight one is farther from the surface, if that bends as its sides do."""
ALONG = np.arange(1, 8) / 8.0
"""Places along an arc."""


class CurvedDeviation(NamedTuple):
    """Distances over each of m triangles, model units."""

    largest: NDArray[np.float64]  # (m,)
    mean_square: NDArray[np.float64]  # (m,) over the samples
    point: NDArray[np.float64]  # (m, 3) where it is largest, on the triangle
    uv: NDArray[np.float64]  # (m, 2) of the nearest point of the surface


def shape_functions(weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """(q, 6) of the nodes at barycentric weights (q, 3)."""
    r, s, t = weights.T
    corners = weights * (2.0 * weights - 1.0)
    return np.column_stack([corners, 4.0 * r * s, 4.0 * s * t, 4.0 * t * r])


def points_on(nodes: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m, q, 3) at weights (q, 3) of triangles with nodes (m, 6, 3)."""
    return np.einsum("qk,mkd->mqd", shape_functions(weights), nodes)


def are_bent(
    points: NDArray[np.float64], middles: NDArray[np.float64], edges: NDArray[np.int32],
    of_triangles: NDArray[np.int64], chord: NDArray[np.float64],
) -> NDArray[np.bool_]:  # fmt: skip
    """(m,) which triangles have a side whose node (e, 3) lies farther than ``SLIGHT`` chords, of
    its own (m,), from the middle of its ends. edges (e, 2); of_triangles (m, 3) their sides."""
    bend = np.linalg.norm(middles - points[edges].mean(axis=1), axis=1)
    return bend[of_triangles].max(axis=1) > SLIGHT * chord


def curved_deviations(
    surface: Surface, nodes: NDArray[np.float64], uv: NDArray[np.float64], limit: float
) -> CurvedDeviation:
    """Of triangles with nodes (m, 6, 3) and parameters (m, 3, 2) of their corners from a surface.

    limit: farther points are searched for anew from the corners of their triangles.
    """
    parts = []
    for start in range(0, len(nodes), BLOCK // len(WITHIN)):
        own = slice(start, start + BLOCK // len(WITHIN))
        points = points_on(nodes[own], WITHIN)
        count = len(points)
        guess = np.einsum("qk,mkd->mqd", WITHIN, uv[own]).reshape(-1, 2)
        foot, distance = nearest_deviations(
            surface, points.reshape(-1, 3), guess, np.ascontiguousarray(uv[own]),
            np.repeat(np.arange(count), len(WITHIN)), limit, STEPS,
        )  # fmt: skip
        distance, foot = distance.reshape(count, -1), foot.reshape(count, -1, 2)
        top = distance.argmax(axis=1)
        row = np.arange(count)
        mean = (distance**2).mean(axis=1)
        parts.append(CurvedDeviation(distance[row, top], mean, points[row, top], foot[row, top]))
    return CurvedDeviation(*(np.concatenate(columns) for columns in zip(*parts)))


Curves = Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]
"""t (n,) from 0 to 1 -> points (n, 3), one on each of n curves, and their derivatives by t."""


def arc_deviations(
    curves: Curves, nodes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest distances (n,) of arcs with nodes (n, 3, 3), start, middle, end, from their curves,
    and the points (n, 3) of the arcs where it is.

    The search is Gauss-Newton along the curve, from the same t.
    """
    largest, place = np.full(len(nodes), -1.0), nodes[:, 1].copy()
    for s in ALONG:
        functions = np.array([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)])
        point = np.einsum("k,nkd->nd", functions, nodes)
        distance = _to_curves(curves, point, np.full(len(nodes), s))
        farther = distance > largest
        largest[farther], place[farther] = distance[farther], point[farther]
    return largest, place


def _to_curves(
    curves: Curves, points: NDArray[np.float64], t: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Distances (n,) of points (n, 3), each from its curve near t (n,); never more than at t."""
    least = np.full(len(points), np.inf)
    for _ in range(CURVE_STEPS):
        at, slope = curves(t)
        way = points - at
        least = np.minimum(least, np.linalg.norm(way, axis=1))
        squared = np.einsum("ij,ij->i", slope, slope)
        step = np.einsum("ij,ij->i", way, slope) / np.where(squared > 0.0, squared, 1.0)
        t = np.clip(t + step, -0.1, 1.1)
    return least
