"""Plane geometry in rational arithmetic: floats are exact fractions."""

from fractions import Fraction

import numpy as np

FILTER = 1e-14


def orient(a, b, c) -> Fraction:
    """Twice the signed area of abc."""
    ax, ay, bx, by, cx, cy = (Fraction(float(x)) for x in (*a, *b, *c))
    return (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)


def sign(x) -> int:
    return (x > 0) - (x < 0)


def orient_signs(a, b, c) -> np.ndarray:
    """Signs of orient for points (n, 2) each: floats where they suffice, fractions elsewhere."""
    left = (a[:, 0] - c[:, 0]) * (b[:, 1] - c[:, 1])
    right = (a[:, 1] - c[:, 1]) * (b[:, 0] - c[:, 0])
    signs = np.sign(left - right).astype(int)
    doubtful = ~(np.abs(left - right) > FILTER * (np.abs(left) + np.abs(right)))
    for k in np.flatnonzero(doubtful):
        signs[k] = sign(orient(a[k], b[k], c[k]))
    return signs


def polygon_area(xy) -> Fraction:
    """Twice the signed area of the polygon (n, 2)."""
    points = [(Fraction(float(x)), Fraction(float(y))) for x, y in xy]
    return sum(
        (p[0] * q[1] - q[0] * p[1] for p, q in zip(points, points[1:] + points[:1])), Fraction(0)
    )


def triangles_area(xy, triangles) -> Fraction:
    """Twice the sum of the signed areas."""
    return sum((orient(*xy[list(t)]) for t in triangles), Fraction(0))


def segments_meet(a, b, c, d) -> bool:
    """Do the closed segments ab and cd have a point in common?"""
    abc, abd = sign(orient(a, b, c)), sign(orient(a, b, d))
    cda, cdb = sign(orient(c, d, a)), sign(orient(c, d, b))
    if abc * abd < 0 and cda * cdb < 0:
        return True
    return any(
        s == 0 and _between(p, q, x)
        for s, p, q, x in ((abc, a, b, c), (abd, a, b, d), (cda, c, d, a), (cdb, c, d, b))
    )


def _between(p, q, x) -> bool:
    """Is x, on the line pq, within the segment?"""
    return all(min(p[i], q[i]) <= x[i] <= max(p[i], q[i]) for i in range(2))


def first_crossing(xy) -> tuple[int, int] | None:
    """Two edges of the closed polygon (n, 2) that meet other than at their common corner."""
    n = len(xy)
    after = np.roll(xy, -1, axis=0)
    low, high = np.minimum(xy, after), np.maximum(xy, after)
    for i in range(n):
        near = (low <= high[i]).all(axis=1) & (high >= low[i]).all(axis=1)
        for j in np.flatnonzero(near[i + 1 :]) + i + 1:
            if j == i + 1 or (i == 0 and j == n - 1):  # one corner in common: no overlap?
                p, q, r = (xy[i], xy[j], after[j]) if j == i + 1 else (xy[j], xy[i], after[i])
                backwards = (q - p) @ (r - q) < 0
                if backwards and orient(p, q, r) == 0:
                    return i, int(j)
            elif segments_meet(xy[i], after[i], xy[j], after[j]):
                return i, int(j)
    return None
