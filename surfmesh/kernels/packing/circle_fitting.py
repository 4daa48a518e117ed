"""Fitting a circle to its neighbours by iteration, its size read from a field (2.3.2, 2.3.3)."""

import math

from surfmesh.kernels import NIL
from surfmesh.kernels.fields.background import size_at
from surfmesh.kernels.fields.tensors import solve
from surfmesh.kernels.jit import inlined_kernel, kernel
from surfmesh.kernels.packing.packing_state import STEPS

CLOSENESS = 0.98  # beta1 beta2 above which a fit is accepted (2.3.2)
FIT_STEPS = 8
NEIGHBOURS_WITHIN = 1.4  # circles nearer than this are neighbours of the one to place
TOUCHED_WITHIN = 0.08  # a neighbour at 1 -+ this is touched well enough


@inlined_kernel
def _apex(h11, h12, h22, dx, dy):
    """Step from the middle of an edge (dx, dy) to the apex on its right, both sides unit."""
    x, y = solve(h11, h12, h22, dx, dy)
    base = math.sqrt(x * x + y * y)
    height = math.sqrt(max(1.0 - 0.25 * base * base, 0.25)) / base
    rx, ry = y * height, -x * height
    return h11 * rx + h12 * ry, h12 * rx + h22 * ry


@kernel
def fit_to_two(xy, size, count, background, a, b):
    """The circle that touches those of a and b, right of a -> b (2.3.2).

    Its size depends on where it ends up: Newton on (l(P, a), l(P, b)) = (1, 1), the size
    read again at each step. Returns x, y, its size tensor and beta1 beta2.
    """
    ax, ay, bx, by = xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1]
    a11, a12, a22 = size[a, 0], size[a, 1], size[a, 2]
    b11, b12, b22 = size[b, 0], size[b, 1], size[b, 2]
    dx, dy = _apex(0.5 * (a11 + b11), 0.5 * (a12 + b12), 0.5 * (a22 + b22), bx - ax, by - ay)
    x = 0.5 * (ax + bx) + dx
    y = 0.5 * (ay + by) + dy
    best = -1.0
    best_x, best_y = x, y
    best_11, best_12, best_22 = a11, a12, a22
    for step in range(FIT_STEPS):
        h11, h12, h22 = size_at(background, x, y)
        count[STEPS] += 1
        m11, m12, m22 = 0.5 * (h11 + a11), 0.5 * (h12 + a12), 0.5 * (h22 + a22)
        ux, uy = solve(m11, m12, m22, x - ax, y - ay)
        la = math.sqrt(ux * ux + uy * uy)
        gax, gay = solve(m11, m12, m22, ux / la, uy / la)
        m11, m12, m22 = 0.5 * (h11 + b11), 0.5 * (h12 + b12), 0.5 * (h22 + b22)
        ux, uy = solve(m11, m12, m22, x - bx, y - by)
        lb = math.sqrt(ux * ux + uy * uy)
        gbx, gby = solve(m11, m12, m22, ux / lb, uy / lb)
        close = min(la, 1.0 / la) * min(lb, 1.0 / lb)
        if close > best:
            best, best_x, best_y = close, x, y
            best_11, best_12, best_22 = h11, h12, h22
        if close > CLOSENESS and (step > 0 or close > 0.98):
            break
        det = gax * gby - gay * gbx
        if abs(det) < 1e-3 * (abs(gax * gby) + abs(gay * gbx)):
            break
        ra, rb = 1.0 - la, 1.0 - lb
        x += (gby * ra - gay * rb) / det
        y += (gax * rb - gbx * ra) / det
        # stay on the right of a -> b: outside the front
        if (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0.0:
            break
    return best_x, best_y, best_11, best_12, best_22, best


@kernel
def fit_to_three(xy, size, count, background, a, b, c, x, y):
    """The circle that touches those of a, b and c (2.3.3), sought from (x, y).

    Newton on l(P, a) = l(P, b) = l(P, c) = r. Returns x, y, the size tensor there and r (the
    radius got is 2 r - 1 times the wanted one when the others keep theirs), or r = 0.
    """
    r = 0.0
    h11, h12, h22 = size_at(background, x, y)
    for _ in range(FIT_STEPS):
        la = lb = lc = 0.0
        gax = gay = gbx = gby = gcx = gcy = 0.0
        for k in range(3):
            v = a if k == 0 else (b if k == 1 else c)
            m11, m12 = 0.5 * (h11 + size[v, 0]), 0.5 * (h12 + size[v, 1])
            m22 = 0.5 * (h22 + size[v, 2])
            ux, uy = solve(m11, m12, m22, x - xy[v, 0], y - xy[v, 1])
            l = math.sqrt(ux * ux + uy * uy)
            if l < 1e-12:
                return x, y, h11, h12, h22, 0.0
            gx, gy = solve(m11, m12, m22, ux / l, uy / l)
            if k == 0:
                la, gax, gay = l, gx, gy
            elif k == 1:
                lb, gbx, gby = l, gx, gy
            else:
                lc, gcx, gcy = l, gx, gy
        r = (la + lb + lc) / 3.0
        if max(abs(la - r), abs(lb - r), abs(lc - r)) < 0.01 * r:
            return x, y, h11, h12, h22, r
        # (ga - gb) d = lb - la, (ga - gc) d = lc - la
        m00, m01, m10, m11 = gax - gbx, gay - gby, gax - gcx, gay - gcy
        det = m00 * m11 - m01 * m10
        if abs(det) < 1e-6 * (abs(m00 * m11) + abs(m01 * m10)):
            return x, y, h11, h12, h22, 0.0
        x += (m11 * (lb - la) - m01 * (lc - la)) / det
        y += (m00 * (lc - la) - m10 * (lb - la)) / det
        h11, h12, h22 = size_at(background, x, y)
        count[STEPS] += 1
    return x, y, h11, h12, h22, 0.0


@inlined_kernel
def relax_against_neighbours(t, a, b, rims, x, y, h11, h12, h22, reach):
    """Look at the circles on the rim around a circle at (x, y).

    Returns the nearest one below ``reach`` (not a or b), or NIL; and the step to the place
    that best touches all near ones, or no step when they are touched well enough. Between two
    circles of the front there is seldom room for exactly one more: one Gauss-Newton step on
    the sum of (l - 1)^2 over the neighbours shares the misfit.
    """
    nearest, shortest, crowded = NIL, reach, False
    n11 = n12 = n22 = g1 = g2 = 0.0
    for k in range(rims):
        v = t.tri[t.rim[k]]
        if v == NIL:
            continue
        m11, m12 = 0.5 * (h11 + t.size[v, 0]), 0.5 * (h12 + t.size[v, 1])
        m22 = 0.5 * (h22 + t.size[v, 2])
        det = m11 * m22 - m12 * m12
        dx, dy = x - t.xy[v, 0], y - t.xy[v, 1]
        ux, uy = (m22 * dx - m12 * dy) / det, (m11 * dy - m12 * dx) / det
        l = math.sqrt(ux * ux + uy * uy)
        if l >= NEIGHBOURS_WITHIN:
            continue
        if v != a and v != b:
            if l < shortest:
                shortest, nearest = l, v
            if abs(l - 1.0) > TOUCHED_WITHIN:
                crowded = True
        i = 1.0 / (l * det)
        gx, gy = (m22 * ux - m12 * uy) * i, (m11 * uy - m12 * ux) * i
        n11 += gx * gx
        n12 += gx * gy
        n22 += gy * gy
        g1 += gx * (1.0 - l)
        g2 += gy * (1.0 - l)
    det = n11 * n22 - n12 * n12
    if not crowded or not det > 1e-12 * n11 * n22:
        return nearest, 0.0, 0.0
    return nearest, (n22 * g1 - n12 * g2) / det, (n11 * g2 - n12 * g1) / det
