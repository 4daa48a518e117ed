"""Exact orientation of four points in space, by the same means as in the plane.

A floating-point filter settles almost every case; the rest is a sum of 96 products without
error, kept as an expansion: numbers that do not overlap, the largest last (J.R. Shewchuk,
Adaptive precision floating-point arithmetic, Discrete & Computational Geometry 18, 1997).
Where products of three coordinates may under- or overflow, their exponents are kept as integers
(``exact_sums``): the sign is that of the given numbers for all finite ones.
"""

import math

import numpy as np

from surfmesh.kernels.jit import kernel
from surfmesh.kernels.triangulation.exact_sums import exact_sum
from surfmesh.kernels.triangulation.predicates import EPSILON, UNDERFLOW, _two_product, _two_sum

FILTER_SPACE = (7.0 + 56.0 * EPSILON) * EPSILON  # Shewchuk's o3derrboundA
TERMS = 96  # of the sum, hence the most that an expansion of it can hold
WORKSPACE = 2 * TERMS
"""Numbers to work in that ``orient_space`` is handed: terms, and their exponents."""
SMALL, LARGE = 2.0**-300, 2.0**330  # products of three numbers between them have exact errors


@kernel
def _grow(expansion, length, term):
    """Add a number to an expansion, zeros left out (Shewchuk's Grow-Expansion); its length."""
    kept = 0
    for i in range(length):
        term, error = _two_sum(term, expansion[i])
        if error != 0.0:
            expansion[kept] = error
            kept += 1
    if term != 0.0:
        expansion[kept] = term
        kept += 1
    return kept


@kernel
def _add_product(expansion, length, a, b, c):
    """Add a b c, which is a sum of four numbers; the expansion's new length."""
    high, low = _two_product(a, b)
    upper, error = _two_product(high, c)
    length = _grow(expansion, length, error)
    length = _grow(expansion, length, upper)
    upper, error = _two_product(low, c)
    length = _grow(expansion, length, error)
    return _grow(expansion, length, upper)


@kernel
def _add_determinant(expansion, length, sign, p, a, b, c):
    """Add sign times the determinant of three points; the expansion's new length."""
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        length = _add_product(expansion, length, sign * p[a, i], p[b, j], p[c, k])
        length = _add_product(expansion, length, -sign * p[a, i], p[b, k], p[c, j])
    return length


@kernel
def _orient_space_exact(p, a, b, c, d, expansion):
    length = _add_determinant(expansion, 0, 1.0, p, a, b, c)
    length = _add_determinant(expansion, length, -1.0, p, d, b, c)
    length = _add_determinant(expansion, length, -1.0, p, a, d, c)
    length = _add_determinant(expansion, length, -1.0, p, a, b, d)
    return expansion[length - 1] if length else 0.0


@kernel
def _ordinary(p, k):
    for i in range(3):
        if p[k, i] != 0.0 and not SMALL < abs(p[k, i]) < LARGE:
            return False
    return True


@kernel
def _finite(p, k):
    return np.isfinite(p[k, 0]) and np.isfinite(p[k, 1]) and np.isfinite(p[k, 2])


@kernel
def _put_product(work, count, a, b, c):
    """Put a b c as four terms and their exponents into the workspace; how many are in it."""
    (a, i), (b, j), (c, k) = math.frexp(a), math.frexp(b), math.frexp(c)
    high, low = _two_product(a, b)
    work[count], work[count + 1] = _two_product(high, c)
    work[count + 2], work[count + 3] = _two_product(low, c)
    for n in range(count, count + 4):
        work[TERMS + n] = i + j + k
    return count + 4


@kernel
def _orient_space_of_any_size(p, a, b, c, d, work):
    """As ``_orient_space_exact``, on mantissas; nan where a coordinate is not finite."""
    if not (_finite(p, a) and _finite(p, b) and _finite(p, c) and _finite(p, d)):
        return np.nan
    count = 0
    for sign, q, r, s in ((1.0, a, b, c), (-1.0, d, b, c), (-1.0, a, d, c), (-1.0, a, b, d)):
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            count = _put_product(work, count, sign * p[q, i], p[r, j], p[s, k])
            count = _put_product(work, count, -sign * p[q, i], p[r, k], p[s, j])
    return exact_sum(work[:TERMS], work[TERMS:], TERMS)


@kernel
def _orient_space_without_filter(p, a, b, c, d, expansion):
    if _ordinary(p, a) and _ordinary(p, b) and _ordinary(p, c) and _ordinary(p, d):
        return _orient_space_exact(p, a, b, c, d, expansion)
    return _orient_space_of_any_size(p, a, b, c, d, expansion)


@kernel
def orient_space(p, a, b, c, d, expansion):
    """Six times the signed volume of abcd; its sign is exact: > 0 where abc is seen from d
    clockwise. For all finite coordinates.

    Parameters
    ----------
    p: (n, 3) float64, and a, b, c, d rows of it
    expansion: (WORKSPACE,) float64, to work in
    """
    ax, ay, az = p[a, 0] - p[d, 0], p[a, 1] - p[d, 1], p[a, 2] - p[d, 2]
    bx, by, bz = p[b, 0] - p[d, 0], p[b, 1] - p[d, 1], p[b, 2] - p[d, 2]
    cx, cy, cz = p[c, 0] - p[d, 0], p[c, 1] - p[d, 1], p[c, 2] - p[d, 2]
    bc, cb = bx * cy, cx * by
    ca, ac = cx * ay, ax * cy
    ab, ba = ax * by, bx * ay
    det = az * (bc - cb) + bz * (ca - ac) + cz * (ab - ba)
    permanent = (
        (abs(bc) + abs(cb) + UNDERFLOW) * abs(az)
        + (abs(ca) + abs(ac) + UNDERFLOW) * abs(bz)
        + (abs(ab) + abs(ba) + UNDERFLOW) * abs(cz)
    )
    if abs(det) > FILTER_SPACE * permanent + UNDERFLOW:
        return det
    if (
        (ax == 0.0 and bx == 0.0 and cx == 0.0)
        or (ay == 0.0 and by == 0.0 and cy == 0.0)
        or (az == 0.0 and bz == 0.0 and cz == 0.0)
    ):
        return 0.0  # on a plane across an axis: common, and a difference of zero is exact
    return _orient_space_without_filter(p, a, b, c, d, expansion)
