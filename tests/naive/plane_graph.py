"""Twins of the noding: every pair of segments, in rational arithmetic."""

from fractions import Fraction
from itertools import pairwise

import numpy as np

from naive import exact


def first_meeting(points, segments) -> tuple[int, int] | None:
    """Two segments that meet other than at one common end."""
    for i in range(len(segments)):
        for j in range(i):
            common = set(segments[i]) & set(segments[j])
            (a, b), (c, d) = points[segments[i]], points[segments[j]]
            if not common:
                if exact.segments_meet(a, b, c, d):
                    return i, j
            elif len(common) == 2 or _overlap(points, segments[i], segments[j], *common):
                return i, j
    return None


def _overlap(points, first, second, common) -> bool:
    p = points[common]
    (q,) = (points[k] for k in first if k != common)
    (r,) = (points[k] for k in second if k != common)
    along = sum(Fraction(float(q[i] - p[i])) * Fraction(float(r[i] - p[i])) for i in range(2))
    return exact.orient(p, q, r) == 0 and along > 0


def distance(point, starts, ends) -> float:
    """From a point to the nearest of many segments, one by one."""
    best = np.inf
    for a, b in zip(starts, ends):
        d = b - a
        t = np.clip(np.dot(point - a, d) / np.dot(d, d), 0, 1) if d.any() else 0.0
        best = min(best, np.linalg.norm(point - a - t * d))
    return best


def sides(graph, polygons):
    """The regions left and right of each segment; region 0 is the infinite one.

    polygons: bounded faces of the graph with corners at its points. Segments that are on no
    polygon's boundary have 0 on both sides, which is as good as any other region.
    """
    number = {tuple(p): k for k, p in enumerate(graph.points)}
    face = {}
    for k, polygon in enumerate(polygons):
        for ring, wanted in ((polygon.exterior, True), *((r, False) for r in polygon.interiors)):
            corners = [number[p] for p in ring.coords]
            if ring.is_ccw != wanted:
                corners.reverse()
            face.update({edge: k + 1 for edge in pairwise(corners)})
    left = [face.get((i, j), 0) for i, j in graph.segments.tolist()]
    right = [face.get((j, i), 0) for i, j in graph.segments.tolist()]
    return np.array(left), np.array(right)
