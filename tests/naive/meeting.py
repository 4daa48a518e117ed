"""Where two triangles in space meet, in rational arithmetic: one is cut by the other's planes."""

from fractions import Fraction
from itertools import combinations

import numpy as np


def _minus(a, b):
    return [x - y for x, y in zip(a, b)]


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def orient_space(a, b, c, d) -> Fraction:
    """Six times the signed volume of abcd."""
    a, b, c, d = ([Fraction(float(x)) for x in point] for point in (a, b, c, d))
    return _dot(_minus(a, d), _cross(_minus(b, d), _minus(c, d)))


def _clipped(polygon, at, normal):
    """The part of a convex polygon (a segment, a point) behind a plane, border included."""
    kept = []
    for k, q in enumerate(polygon):
        p = polygon[k - 1]
        here, there = _dot(_minus(p, at), normal), _dot(_minus(q, at), normal)
        if (here < 0 < there) or (there < 0 < here):
            fraction = here / (here - there)
            kept.append([x + fraction * (y - x) for x, y in zip(p, q)])
        if there <= 0:
            kept.append(q)
    return kept


def common_points(first, second) -> list:
    """Corners of what two triangles (3, 3) have in common, a convex polygon; empty: nothing."""
    a, polygon = ([[Fraction(float(x)) for x in p] for p in t] for t in (first, second))
    normal = _cross(_minus(a[1], a[0]), _minus(a[2], a[0]))
    planes = [(a[0], normal), (a[0], [-x for x in normal])]
    planes += [(a[k - 1], _cross(_minus(a[k], a[k - 1]), normal)) for k in range(3)]
    for at, outwards in planes:
        polygon = _clipped(polygon, at, outwards)
    return polygon


def has_area(triangle) -> bool:
    a, b, c = ([Fraction(float(x)) for x in p] for p in triangle)
    return any(_cross(_minus(b, a), _minus(c, a)))


def meet(first, second) -> bool:
    """Do two triangles meet beyond what they share? Corners at one place are shared."""
    if not has_area(first) or not has_area(second):
        return False
    places = [tuple(Fraction(float(x)) for x in p) for p in first]
    shared = [p for p in places if p in {tuple(Fraction(float(x)) for x in q) for q in second}]
    for point in common_points(first, second):
        if len(shared) in (0, 3):
            return True
        along = _minus(shared[-1], shared[0])
        if any(_cross(along, _minus(point, shared[0])) if any(along) else _minus(point, shared[0])):
            return True
    return False


def meeting_pairs(points, triangles) -> list[tuple[int, int]]:
    """All pairs of triangles that meet."""
    corners = np.asarray(points)[np.asarray(triangles)]
    low, high = corners.min(axis=1), corners.max(axis=1)
    near = [
        (i, j)
        for i, j in combinations(range(len(corners)), 2)
        if (low[i] <= high[j]).all() and (low[j] <= high[i]).all()
    ]
    return [(i, j) for i, j in near if meet(corners[i], corners[j])]
