"""Which points lie within loops in the plane, and how many loops lie around a loop."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfmesh._core.triangulation import inside_loops


def is_inside(loops: Sequence[np.ndarray], points: np.ndarray) -> np.ndarray:
    """(n,) bool for points (n, 2): within an odd number of the loops (k, 2), not closed."""
    first = np.cumsum([0, *map(len, loops)])
    corners = np.concatenate([np.empty((0, 2)), *loops])
    return inside_loops(corners, first, np.ascontiguousarray(points, float)).astype(bool)


def nesting_depth(loops: Sequence[np.ndarray]) -> np.ndarray:
    """For each loop (k, 2), three points or more, the number of others it lies in: (L,) int.

    A loop lies in a larger one that holds a point of its interior; of two equal ones the later
    lies in the earlier, so that by even-odd they cancel.
    """
    import shapely

    with np.errstate(over="ignore", invalid="ignore"):  # of extremes, which are refused later
        polygons = shapely.make_valid([shapely.Polygon(loop) for loop in loops])
        area = shapely.area(polygons)
        probes = shapely.point_on_surface(polygons)
    inner, around = shapely.STRtree(polygons).query(probes, predicate="within")
    rank = np.lexsort((np.arange(len(loops)), -area))  # larger first, then earlier
    place = np.empty(len(loops), int)
    place[rank] = np.arange(len(loops))
    return np.bincount(inner[place[around] < place[inner]], minlength=len(loops))
