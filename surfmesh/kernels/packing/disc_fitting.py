"""Fitting a circle of a given radius to its neighbours in closed form (2.3.2, 2.3.3).

Where the radius is drawn and not read from a field, no iteration is needed: in the plane a
circle that touches two or three others is the root of a quadratic equation. The size tensor of
a circle of radius r is 2 r Id.
"""

import math

from surfmesh.kernels import NIL
from surfmesh.kernels.jit import inlined_kernel, kernel
from surfmesh.kernels.packing.front import DONE
from surfmesh.kernels.triangulation.triangulation import next_half_edge, prev_half_edge

REACH = 2.0  # of its radius: how far behind the front a circle looks for others
LEAST_HEIGHT = 0.3  # of its radius: how far a circle between two distant ones stands off


@inlined_kernel
def gap_between(t, a, b):
    """Distance between the circles of a and b, negative where they overlap."""
    dx, dy = t.xy[b, 0] - t.xy[a, 0], t.xy[b, 1] - t.xy[a, 1]
    return math.sqrt(dx * dx + dy * dy) - 0.5 * (t.size[a, 0] + t.size[b, 0])


@inlined_kernel
def touch_two(t, a, b, r):
    """The circle of radius r that touches those of a and b, right of a -> b (2.3.2).

    Where the gap between a and b is too wide for it the radius is raised. Returns x, y, r.
    """
    ax, ay = t.xy[a, 0], t.xy[a, 1]
    dx, dy = t.xy[b, 0] - ax, t.xy[b, 1] - ay
    d = math.sqrt(dx * dx + dy * dy)
    ra, rb = 0.5 * t.size[a, 0], 0.5 * t.size[b, 0]
    r = max(r, 0.55 * (d - ra - rb))
    p, q = ra + r, rb + r
    along = 0.5 * (d + (p - q) * (p + q) / d)
    height = math.sqrt(max(p * p - along * along, LEAST_HEIGHT * LEAST_HEIGHT * r * r))
    return ax + (along * dx + height * dy) / d, ay + (along * dy - height * dx) / d, r


@kernel
def touch_three(t, a, b, c):
    """The circle outside those of a, b and c that touches all three (Apollonius; 2.3.3).

    Subtracting |P - A| = r + ra from its two like leaves P linear in r, then a quadratic
    equation for r. Returns x, y, r; r = 0 when there is none.
    """
    ax, ay, ra = t.xy[a, 0], t.xy[a, 1], 0.5 * t.size[a, 0]
    bx, by, rb = t.xy[b, 0] - ax, t.xy[b, 1] - ay, 0.5 * t.size[b, 0]
    cx, cy, rc = t.xy[c, 0] - ax, t.xy[c, 1] - ay, 0.5 * t.size[c, 0]
    det = 2.0 * (bx * cy - by * cx)
    if abs(det) < 1e-9 * (bx * bx + by * by + cx * cx + cy * cy):
        return ax, ay, 0.0
    # 2 b.P = |b|^2 - (rb - ra)(rb + ra + 2 r), P from A
    eb = bx * bx + by * by - (rb - ra) * (rb + ra)
    ec = cx * cx + cy * cy - (rc - ra) * (rc + ra)
    fb, fc = -2.0 * (rb - ra), -2.0 * (rc - ra)
    x0, x1 = (eb * cy - ec * by) / det, (fb * cy - fc * by) / det
    y0, y1 = (bx * ec - cx * eb) / det, (bx * fc - cx * fb) / det
    # |P|^2 = (r + ra)^2
    k2 = x1 * x1 + y1 * y1 - 1.0
    k1 = x0 * x1 + y0 * y1 - ra
    k0 = x0 * x0 + y0 * y0 - ra * ra
    root = k1 * k1 - k2 * k0
    if root < 0.0:
        return ax, ay, 0.0
    root = math.sqrt(root)
    first = k0 / (-k1 + root) if -k1 + root != 0.0 else 0.0
    second = k0 / (-k1 - root) if -k1 - root != 0.0 else 0.0
    r = min(first, second) if min(first, second) > 0.0 else max(first, second)
    if not r > 0.0:
        return ax, ay, 0.0
    return ax + x0 + x1 * r, ay + y0 + y1 * r, r


@inlined_kernel
def _worse(t, v, x, y, r, worst, circle):
    """The deeper of two overlaps: that of the circle v, or the one known, f / (r1 + r2)."""
    dx, dy = t.xy[v, 0] - x, t.xy[v, 1] - y
    reach = r + 0.5 * t.size[v, 0]
    squared = dx * dx + dy * dy
    if squared < worst * worst * reach * reach:
        return math.sqrt(squared) / reach, v
    return worst, circle


@inlined_kernel
def beside(t, u, v, w, x, y, r, tolerance):
    """The one of three circles that a circle of radius r at (x, y) overlaps most, or NIL."""
    worst, circle = 1.0 - tolerance, NIL
    worst, circle = _worse(t, u, x, y, r, worst, circle)
    worst, circle = _worse(t, v, x, y, r, worst, circle)
    if w != NIL:
        worst, circle = _worse(t, w, x, y, r, worst, circle)
    return circle


@inlined_kernel
def _reaches(t, e, x, y, r):
    """Does a circle of radius r at (x, y) reach the edge e?"""
    a, b = t.tri[e], t.tri[next_half_edge(e)]
    dx, dy = t.xy[b, 0] - t.xy[a, 0], t.xy[b, 1] - t.xy[a, 1]
    px, py = x - t.xy[a, 0], y - t.xy[a, 1]
    s = min(max((px * dx + py * dy) / (dx * dx + dy * dy), 0.0), 1.0)
    px, py = px - s * dx, py - s * dy
    return px * px + py * py < r * r


@inlined_kernel
def overlapped(t, a, b, rims, x, y, r, tolerance):
    """The circle that one of radius r at (x, y) overlaps most (2.3.3, f_ij < 0), or NIL.

    Looked at: the circles on the rim of the open cavity, and those behind the front as far as
    the circle reaches through its edges. Overlaps with l = d / (r1 + r2) above
    1 - ``tolerance`` do not count, nor do the supports a and b.
    """
    worst, circle = 1.0 - tolerance, NIL
    bottom = t.stamp[1]  # the rest of ``cavity`` serves as a stack of half-edges to look behind
    top = bottom
    for k in range(rims):
        e = t.rim[k]
        v = t.tri[e]
        if v == NIL:
            continue
        if v != a and v != b:
            worst, circle = _worse(t, v, x, y, r, worst, circle)
        if t.region[t.adj[e] // 3] == DONE and top < len(t.cavity):
            t.cavity[top] = t.adj[e]
            top += 1
    while top > bottom:
        top -= 1
        e = t.cavity[top]
        v = t.tri[prev_half_edge(e)]
        if v == NIL or t.mark[e // 3] == -t.stamp[0]:
            continue
        t.mark[e // 3] = -t.stamp[0]
        if v != a and v != b:
            worst, circle = _worse(t, v, x, y, r, worst, circle)
        for f in (next_half_edge(e), prev_half_edge(e)):
            behind = t.region[t.adj[f] // 3] == DONE
            if behind and top < len(t.cavity) and _reaches(t, f, x, y, REACH * r):
                t.cavity[top] = t.adj[f]
                top += 1
    return circle
