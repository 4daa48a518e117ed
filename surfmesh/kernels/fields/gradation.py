"""Gradation and accuracy of a size field on patches of nine nodes.

A cell of the background under construction is a patch, nodes numbered row by row:

        6 - 7 - 8
        |   |   |       corners 0 2 6 8 are the cell's own;
        3 - 4 - 5       the other five test it, and serve its children when it is split
        |   |   |
        0 - 1 - 2
"""

import math
from typing import NamedTuple

import numpy as np

from surfmesh.kernels.jit import kernel

ROUNDING = 1e-9  # a size is not lowered for less
TURN_SLOPE = 3.0  # how much faster than sizes a metric may change because its direction turns

_NONE = np.empty(0, np.uint8)


class Metric(NamedTuple):
    """What makes sizes anisotropic: h holds at right angles to ``along``. Empty if isotropic."""

    long: np.ndarray  # (nodes,) size along ``along``; gradation may make it the shorter one
    along: np.ndarray  # (nodes, 3) unit vector in the tangent plane
    normal: np.ndarray  # (nodes, 3) unit, or zero where there is none: isotropic there
    round: np.ndarray = _NONE  # (nodes,) uint8: ``long`` stays the longer one here; or empty


@kernel
def _limit(h, r, slope, a, b, changed, sweep):
    """Let neither of h[a], h[b] exceed the other by more than slope times their distance.

    Returns the relative change, and notes in ``changed`` which node it was.
    """
    if h[a] == h[b]:
        return 0.0
    d = math.sqrt((r[a, 0] - r[b, 0]) ** 2 + (r[a, 1] - r[b, 1]) ** 2 + (r[a, 2] - r[b, 2]) ** 2)
    if h[a] > h[b] + slope * d:
        change = h[a] - h[b] - slope * d
        h[a] = h[b] + slope * d
        changed[a] = sweep
        return change / h[a]
    if h[b] > h[a] + slope * d:
        change = h[b] - h[a] - slope * d
        h[b] = h[a] + slope * d
        changed[b] = sweep
        return change / h[b]
    return 0.0


@kernel
def _carried(metric, a, b):
    """``along`` of a in the tangent plane of b: components along and left of that of b.

    Turned with the normal by the smallest rotation. Normals may be opposite across a joint.
    """
    n, m, t = metric.normal[a], metric.normal[b], metric.along[a]
    x, y, z = t[0], t[1], t[2]
    c = n[0] * m[0] + n[1] * m[1] + n[2] * m[2]
    sign = 1.0 if c >= 0.0 else -1.0
    k = sign * (x * m[0] + y * m[1] + z * m[2]) / (1.0 + abs(c))
    x -= k * (n[0] + sign * m[0])
    y -= k * (n[1] + sign * m[1])
    z -= k * (n[2] + sign * m[2])
    s = metric.along[b]
    along = x * s[0] + y * s[1] + z * s[2]
    left = (
        x * (m[1] * s[2] - m[2] * s[1])
        + y * (m[2] * s[0] - m[0] * s[2])
        + z * (m[0] * s[1] - m[1] * s[0])
    )
    d = math.sqrt(along * along + left * left)
    if d == 0.0:
        return 1.0, 0.0
    return along / d, left / d


@kernel
def _bind(h, metric, r, slope, a, b, changed, sweep):
    """Lower the sizes of b until its metric contains that of a, grown over their distance.

    Over the distance l, in the metric of a, the sizes in the directions of b may grow by
    g = 1 + slope l; as a whole, M_b - M_a / f^2 must be positive definite for the faster
    f = 1 + TURN_SLOPE slope l. The first bounds both sizes of b; what is wanting in the second
    is due to a direction that turns, and shortens the size along ``along`` alone, as long as
    none smaller than the smallest of a, grown, is needed: principal directions stay what they
    are, and the size along one may become the shorter. Returns the relative change of b.
    """
    dx, dy, dz = r[b, 0] - r[a, 0], r[b, 1] - r[a, 1], r[b, 2] - r[a, 2]
    t = metric.along[a]
    along = dx * t[0] + dy * t[1] + dz * t[2]
    left = max(dx * dx + dy * dy + dz * dz - along * along, 0.0)
    along /= metric.long[a]
    distance = math.sqrt(along * along + left / (h[a] * h[a]))
    growth = 1.0 + slope * distance
    short = growth * min(h[a], metric.long[a])
    hb, lb = h[b], metric.long[b]
    if max(hb, lb) <= short:
        return 0.0
    n = metric.normal[b]
    if n[0] == 0.0 and n[1] == 0.0 and n[2] == 0.0:
        change = max(hb, lb) / short - 1.0
        h[b], metric.long[b] = min(hb, short), min(lb, short)
        changed[b] = sweep
        return change
    c, s = _carried(metric, a, b)
    # the metric of a in the axes of b: x for its longer, y for its shorter one
    x, y = 1.0 / (metric.long[a] * metric.long[a]), 1.0 / (h[a] * h[a])
    mx, my, mxy = c * c * x + s * s * y, s * s * x + c * c * y, c * s * (y - x)
    f = 1.0 / (1.0 + TURN_SLOPE * slope * distance) ** 2
    g = 1.0 / (growth * growth)
    y = max(1.0 / (hb * hb), g * my)
    x = max(1.0 / (lb * lb), g * mx)
    most = 1.0 / (short * short)  # no direction needs less than the smallest size of a, grown
    need = 0.0
    if y > f * my:  # not between two images of one point
        need = min(f * mx + (f * mxy) ** 2 / (y - f * my), most)
    x = max(x, need)
    if need == most:
        y = max(y, min(f * my + (f * mxy) ** 2 / max(x - f * mx, 1e-12 * most), most))
    if x > y and len(metric.round) > 0 and metric.round[b] != 0:
        y = x
    long = min(1.0 / math.sqrt(x), lb)
    short = min(1.0 / math.sqrt(y), hb)
    change = max(lb / long, hb / short) - 1.0
    if change <= ROUNDING:
        return 0.0
    h[b], metric.long[b] = short, long
    changed[b] = sweep
    return change


@kernel
def _level(h, metric, r, slope, a, b, changed, sweep):
    """Let neither of a and b exceed what the other allows; returns the relative change."""
    if len(metric.long) == 0:
        return _limit(h, r, slope, a, b, changed, sweep)
    first = _bind(h, metric, r, slope, a, b, changed, sweep)
    return max(first, _bind(h, metric, r, slope, b, a, changed, sweep))


@kernel
def grade(patch, joined, r, slope, h, metric, changed, first, sweeps):
    """Lower the sizes h (nodes,) until no two neighbours differ by more than the slope allows.

    patch (cells, 9) nodes; joined (k, 2) pairs of nodes that are neighbours across a joint of
    two sides; r (nodes, 3) points. ``changed`` (nodes,) int32 holds the number of the last
    sweep that lowered a node; sweeps are numbered from ``first`` on and pass over patches that
    the sweep before has left alone. Sizes spread from small to large, so a few sweeps do when
    the patches with the smallest sizes come first. Stops when the largest relative change is
    below 0.1%.
    Returns the number for the next sweep, negative when ``sweeps`` did not suffice.
    """
    n = len(patch)
    for sweep in range(first, first + sweeps):
        largest = 0.0
        for k in range(n):
            p = patch[k]
            latest = 0
            for i in range(9):
                latest = max(latest, changed[p[i]])
            if latest < sweep - 1:
                continue
            for i in range(9):  # right, up and the two diagonals of each node of the 3 x 3
                right = i % 3 < 2
                for way in range(4):
                    if (way != 1 and not right) or (way != 0 and i >= 6):
                        continue
                    a = p[i + 1] if way == 3 else p[i]
                    b = p[i + 1] if way == 0 else p[i + 4] if way == 2 else p[i + 3]
                    found = _level(h, metric, r, slope, a, b, changed, sweep)
                    largest = max(largest, found)
        for k in range(len(joined)):
            a, b = joined[k, 0], joined[k, 1]
            largest = max(largest, _level(h, metric, r, slope, a, b, changed, sweep))
        if largest < 1e-3:
            return sweep + 2  # nothing is newer than the sweep before the next
    return -(first + sweeps)


@kernel
def _relative_error(x11, x12, x22, a11, a12, a22, floor):
    """Frobenius norm of A^-1 (X - A), with the eigenvalues of A kept above ``floor``."""
    d11, d12, d22 = x11 - a11, x12 - a12, x22 - a22
    a11 += floor
    a22 += floor
    det = a11 * a22 - a12 * a12
    e11 = a22 * d11 - a12 * d12
    e12 = a22 * d12 - a12 * d22
    e21 = a11 * d12 - a12 * d11
    e22 = a11 * d22 - a12 * d12
    return math.sqrt(e11 * e11 + e12 * e12 + e21 * e21 + e22 * e22) / det


@kernel
def patch_errors(patch, inverse, step, largest, error, extent):
    """How far the field in each patch is from bilinear, and how many edges wide the patch is.

    inverse (nodes, 3) is A = H^-1; step (cells, 2) the patch's width and height.
    error (cells,): largest relative error at the five test nodes; extent (cells,): width or
    height in metric length, whichever is larger.
    """
    floor = 1.0 / largest
    for k in range(len(patch)):
        p = patch[k]
        worst = 0.0
        for m in range(5):
            i = 4 if m == 4 else 2 * m + 1
            n = p[i]
            x11 = x12 = x22 = 0.0
            for c in range(4):  # bilinear weight of corner c at node i
                column, row = 2 * (c % 2), 2 * (c // 2)
                w = 0.25 * (2 - abs(i % 3 - column)) * (2 - abs(i // 3 - row))
                q = p[3 * row + column]
                x11 += w * inverse[q, 0]
                x12 += w * inverse[q, 1]
                x22 += w * inverse[q, 2]
            a11, a12, a22 = inverse[n, 0], inverse[n, 1], inverse[n, 2]
            worst = max(worst, _relative_error(x11, x12, x22, a11, a12, a22, floor))
        error[k] = worst
        wide = 0.0
        for i in range(9):
            n = p[i]
            a11, a12, a22 = inverse[n, 0], inverse[n, 1], inverse[n, 2]
            wide = max(wide, step[k, 0] * math.sqrt(a11 * a11 + a12 * a12))
            wide = max(wide, step[k, 1] * math.sqrt(a12 * a12 + a22 * a22))
        extent[k] = wide
