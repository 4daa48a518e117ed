"""The regions into which the segments of a planar domain divide the plane, as polygons."""

from __future__ import annotations

import numpy as np
import shapely

from surfmesh.geometry.planar.segment_graph import SegmentGraph

CROSSINGS_AT_ONCE = 1 << 22  # segments times probes in one numpy operation


def bounded_faces(graph: SegmentGraph) -> tuple[np.ndarray, np.ndarray]:
    """All bounded regions: shapely polygons (f,), and the loops around each (f, L) bool."""
    lines = shapely.linestrings(graph.points[graph.segments])
    polygons = shapely.get_parts(shapely.polygonize(lines))
    with np.errstate(over="ignore"):  # GEOS divides by differences as small as 1e-320
        probes = shapely.get_coordinates(shapely.point_on_surface(polygons))
    return polygons, loops_around(graph, probes)


def inside_faces(graph: SegmentGraph) -> np.ndarray:
    """The regions that are inside the domain, as shapely polygons (f,)."""
    polygons, around = bounded_faces(graph)
    holes = (around & graph.loop_is_hole).sum(axis=1)
    return polygons[around.sum(axis=1) - holes > holes]


def loops_around(graph: SegmentGraph, probes: np.ndarray) -> np.ndarray:
    """Which loops lie around points (n, 2) that are on no segment: (n, L) bool.

    Counts the crossings of a ray to the right.
    """
    segment, loop = graph.loop_segments.T
    a, b = graph.points[graph.segments[segment]].transpose(1, 0, 2)
    order = np.argsort(loop, kind="stable")
    a, b, starts = a[order], b[order], np.searchsorted(loop[order], np.arange(loop.max() + 1))
    run, rise = (b - a).T
    upward = rise > 0.0
    around = np.empty((len(probes), len(starts)), bool)
    step = max(1, CROSSINGS_AT_ONCE // max(1, len(a)))
    for first in range(0, len(probes), step):
        x, y = probes[first : first + step, :, None].transpose(1, 0, 2)
        crosses = (a[:, 1] > y) != (b[:, 1] > y)
        # no division: rises may be as small as 1e-320
        crosses &= ((y - a[:, 1]) * run > (x - a[:, 0]) * rise) == upward
        around[first : first + step] = np.logical_xor.reduceat(crosses, starts, axis=1)
    return around
