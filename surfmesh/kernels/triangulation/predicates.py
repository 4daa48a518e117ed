"""Exact orientation of three points: the one judge of every topological decision.

A floating-point filter settles almost every case; what it cannot settle is computed exactly
with error-free additions (J.R. Shewchuk, Adaptive precision floating-point arithmetic and fast
robust geometric predicates, Discrete & Computational Geometry 18, 1997). Where products of
coordinates may under- or overflow, their exponents are kept as integers (``exact_sums``): the
sign is that of the given numbers for all finite ones.
"""

import math

import numpy as np

from surfmesh.kernels.jit import kernel
from surfmesh.kernels.triangulation.exact_sums import exact_sum

EPSILON = 2.0**-53
FILTER = (3.0 + 16.0 * EPSILON) * EPSILON  # Shewchuk's ccwerrboundA
SPLITTER = 2.0**27 + 1.0
UNDERFLOW = 2.0**-900  # far above what underflow can take from a product, nothing beside others
SMALL, LARGE = 2.0**-450, 2.0**500  # products of two numbers between them have exact errors


@kernel
def _two_product(a, b):
    """a b as a sum (high, low) without error, by Dekker's splitting."""
    high = a * b
    t = SPLITTER * a
    a1 = t - (t - a)
    a0 = a - a1
    t = SPLITTER * b
    b1 = t - (t - b)
    b0 = b - b1
    return high, a0 * b0 - (((high - a1 * b1) - a0 * b1) - a1 * b0)


@kernel
def _two_sum(a, b):
    """a + b as (rounded sum, error), without error (Knuth)."""
    s = a + b
    bb = s - a
    return s, (a - (s - bb)) + (b - bb)


@kernel
def _orient_exact(ax, ay, bx, by, cx, cy):
    """Sign-exact ax by - ay bx + bx cy - by cx + cx ay - cy ax, a sum of twelve terms.

    Sweeps of error-free additions carry the sum to the last term. At the fixed point each
    term is negligible beside the next, so the last one has the sign of the sum. Scalars, not
    an array: kernels own no memory.
    """
    t1, t0 = _two_product(ax, by)
    t3, t2 = _two_product(-ay, bx)
    t5, t4 = _two_product(bx, cy)
    t7, t6 = _two_product(-by, cx)
    t9, t8 = _two_product(cx, ay)
    t11, t10 = _two_product(-cy, ax)
    for _ in range(64):
        old = (t0, t1, t2, t3, t4, t5, t6, t7, t8, t9, t10, t11)
        s = t0
        s, t0 = _two_sum(s, t1)
        s, t1 = _two_sum(s, t2)
        s, t2 = _two_sum(s, t3)
        s, t3 = _two_sum(s, t4)
        s, t4 = _two_sum(s, t5)
        s, t5 = _two_sum(s, t6)
        s, t6 = _two_sum(s, t7)
        s, t7 = _two_sum(s, t8)
        s, t8 = _two_sum(s, t9)
        s, t9 = _two_sum(s, t10)
        s, t10 = _two_sum(s, t11)
        t11 = s
        if old == (t0, t1, t2, t3, t4, t5, t6, t7, t8, t9, t10, t11):
            break
    return t11


@kernel
def _ordinary(x):
    return x == 0.0 or SMALL < abs(x) < LARGE


@kernel
def _orient_of_any_size(ax, ay, bx, by, cx, cy):
    """As ``_orient_exact``, on mantissas; nan where a coordinate is not finite."""
    if not np.isfinite(ax * 0.0 + ay * 0.0 + bx * 0.0 + by * 0.0 + cx * 0.0 + cy * 0.0):
        return np.nan
    (ax, kax), (ay, kay) = math.frexp(ax), math.frexp(ay)
    (bx, kbx), (by, kby) = math.frexp(bx), math.frexp(by)
    (cx, kcx), (cy, kcy) = math.frexp(cx), math.frexp(cy)
    t1, t0 = _two_product(ax, by)
    t3, t2 = _two_product(-ay, bx)
    t5, t4 = _two_product(bx, cy)
    t7, t6 = _two_product(-by, cx)
    t9, t8 = _two_product(cx, ay)
    t11, t10 = _two_product(-cy, ax)
    e0, e2, e4, e6, e8, e10 = kax + kby, kay + kbx, kbx + kcy, kby + kcx, kcx + kay, kcy + kax
    terms = (t0, t1, t2, t3, t4, t5, t6, t7, t8, t9, t10, t11)
    return exact_sum(terms, (e0, e0, e2, e2, e4, e4, e6, e6, e8, e8, e10, e10), 12)


@kernel
def _orient_without_filter(ax, ay, bx, by, cx, cy):
    """One of the two; a function of its own, as it would slow down ``orient``."""
    if (
        _ordinary(ax) and _ordinary(ay) and _ordinary(bx)
        and _ordinary(by) and _ordinary(cx) and _ordinary(cy)
    ):  # fmt: skip
        return _orient_exact(ax, ay, bx, by, cx, cy)
    return _orient_of_any_size(ax, ay, bx, by, cx, cy)


@kernel
def orient(ax, ay, bx, by, cx, cy):
    """Twice the signed area of abc; its sign is exact: > 0 for counter-clockwise.

    For all finite coordinates; where the area is no double, the nearest one that is not zero.
    """
    left = (ax - cx) * (by - cy)
    right = (ay - cy) * (bx - cx)
    det = left - right
    if abs(det) > FILTER * (abs(left) + abs(right)) + UNDERFLOW:
        return det
    if left == 0.0 and right == 0.0 and (ax == cx or by == cy) and (ay == cy or bx == cx):
        return 0.0  # zero factors, not underflow: common on sides parallel to an axis
    return _orient_without_filter(ax, ay, bx, by, cx, cy)


@kernel
def orient_triangles(xy, triangles):
    """The first of the triangles (m, 3) that is not counter-clockwise, or -1; judged exactly."""
    for k in range(len(triangles)):
        a, b, c = triangles[k, 0], triangles[k, 1], triangles[k, 2]
        if orient(xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1]) <= 0.0:
            return k
    return -1
