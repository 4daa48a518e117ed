"""Circle packing by an advancing front (Wang, Ming and Lo 2007, section 2) in a metric.

The circle of a vertex is an ellipse in the plane, given by its size tensor; two touch at
metric length 1, and the paper's closeness beta is min(l, 1/l). The unbounded plane is
triangulated at every moment: what lies inside the front is final, what lies outside is a
coarse triangulation of the front's vertices. That outer part answers the paper's questions
locally and exactly: which circles are near a candidate (its neighbours in the outer part, on
both sides of the front and across a narrow gap alike), is the candidate visible from its
supports, and which polygon is left over when it is not. Hence every triangle is positively
oriented and the front is one simple loop, whatever the sizes.
"""

import math
from typing import NamedTuple

import numpy as np

from surfmesh.kernels import NIL
from surfmesh.kernels.background import size_at
from surfmesh.kernels.front import DONE, TODO, Front, link, unlink
from surfmesh.kernels.heap import Heap, pop, push
from surfmesh.kernels.jit import kernel
from surfmesh.kernels.local_operations import convex, swap
from surfmesh.kernels.predicates import orient
from surfmesh.kernels.tensors import edge_length, solve, triangle_shape
from surfmesh.kernels.triangulation import (
    Triangulation,
    fill_cavity,
    locate,
    next_half_edge,
    open_cavity,
    prev_half_edge,
    rim_visible,
)

# statuses
FINISHED = 0  # the front has left the box, or the wanted number of circles is reached
FULL = 1  # an array is full: grow it and call again
BAD_START = 2  # no three circles about the origin
STUCK = 3  # no edge can be advanced, not even badly: cannot happen in exact arithmetic

CLOSE_BELOW = 1.40  # fill a corner a, b, c straight away when l(a, c) is below this
OVERLAP = 0.65  # a circle nearer than this refuses the candidate
CLOSENESS = 0.95  # beta1 beta2 above which a fit is accepted (2.3.2)
TANGENT_RANGE = 0.72, 1.25  # metric radius at which a circle tangent to three is taken
GOOD_SHAPE = 0.8  # a pair of done triangles both better than this is left as it is
FIT_STEPS = 8
EASE_WITHIN = 1.4  # circles nearer than this are neighbours of the one to place
EASY = 0.08  # a neighbour at 1 -+ this is touched well enough


class Packing(NamedTuple):
    """Everything the packing kernel works on."""

    t: Triangulation
    front: Front
    heap: Heap
    parked: np.ndarray  # (capacity, 2) int32: front edges that wait for their neighbours
    radius: np.ndarray  # (vertices,) float64: got over wanted radius of each circle
    where: np.ndarray  # (10,) float64: origin x, y; box x0, y0, x1, y1; key metric 11, 12, 22
    count: np.ndarray  # (8,) int64: see the indices below


WANTED, PARKED, STEPS, FITS, TANGENTS, CLOSED, FORCED, MOVES = range(8)


@kernel
def _queue(heap, xy, where, a, b):
    """Nearest to the origin first (2.2): by the middle of the edge, in the key metric."""
    x = 0.5 * (xy[a, 0] + xy[b, 0]) - where[0]
    y = 0.5 * (xy[a, 1] + xy[b, 1]) - where[1]
    push(heap, where[6] * x * x + 2.0 * where[7] * x * y + where[8] * y * y, a, b)


@kernel
def _meets_box(xy, where, a, b):
    """Does the segment ab meet the box? (separating axes)"""
    ax, ay, bx, by = xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1]
    x0, y0, x1, y1 = where[2], where[3], where[4], where[5]
    if max(ax, bx) < x0 or min(ax, bx) > x1 or max(ay, by) < y0 or min(ay, by) > y1:
        return False
    nx, ny = by - ay, ax - bx
    middle = nx * (0.5 * (x0 + x1) - ax) + ny * (0.5 * (y0 + y1) - ay)
    reach = 0.5 * (abs(nx) * (x1 - x0) + abs(ny) * (y1 - y0))
    return abs(middle) <= reach


@kernel
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


@kernel
def _open(t, front, a, b, x, y, h11, h12, h22):
    """Open the cavity of a circle at (x, y) on the front edge a -> b.

    Returns (half-edges on its rim, NIL), or (0, the circle that is in the way).
    """
    e = t.adj[front.edge[a]]
    start, barrier = locate(t, e, x, y, True)
    if barrier != NIL:
        v = t.tri[barrier]
        return 0, v if v != a and v != b else t.tri[next_half_edge(barrier)]
    rims = open_cavity(t, start, x, y, h11, h12, h22, True)
    if rims == 0 or t.mark[e // 3] != t.stamp[0]:
        return 0, t.tri[prev_half_edge(e)]
    return rims, NIL


@kernel
def _survey(t, a, b, rims, x, y, h11, h12, h22, reach):
    """Look at the circles on the rim around a circle at (x, y).

    Returns the nearest one below ``reach`` (not a or b), or NIL; and the step to the place
    that best touches all near ones, or no step when they are touched well enough. Between two
    circles of the front there is seldom room for exactly one more: one Gauss-Newton step on
    the sum of (l - 1)^2 over the neighbours shares the misfit.
    """
    nearest, shortest, uneasy = NIL, reach, False
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
        if l >= EASE_WITHIN:
            continue
        if v != a and v != b:
            if l < shortest:
                shortest, nearest = l, v
            if abs(l - 1.0) > EASY:
                uneasy = True
        i = 1.0 / (l * det)
        gx, gy = (m22 * ux - m12 * uy) * i, (m11 * uy - m12 * ux) * i
        n11 += gx * gx
        n12 += gx * gy
        n22 += gy * gy
        g1 += gx * (1.0 - l)
        g2 += gy * (1.0 - l)
    det = n11 * n22 - n12 * n12
    if not uneasy or not det > 1e-12 * n11 * n22:
        return nearest, 0.0, 0.0
    return nearest, (n22 * g1 - n12 * g2) / det, (n11 * g2 - n12 * g1) / det


@kernel
def _place(p, a, b, rims, x, y, h11, h12, h22):
    """Fill the open cavity with a circle at (x, y) and advance the front. Returns the vertex."""
    t = p.t
    v = t.count[0]
    t.count[0] = v + 1
    t.xy[v, 0], t.xy[v, 1] = x, y
    t.size[v, 0], t.size[v, 1], t.size[v, 2] = h11, h12, h22
    fill_cavity(t, rims, v)
    done = t.adj[p.front.edge[a]]  # b -> a in the new triangle (b, a, v)
    t.region[done // 3] = DONE
    link(p.front, a, v, next_half_edge(done))
    link(p.front, v, b, prev_half_edge(done))
    _queue(p.heap, p.t.xy, p.where, a, v)
    _queue(p.heap, p.t.xy, p.where, v, b)
    _settle(t, p.front, done)
    return v


@kernel
def _settle(t, front, e):
    """Swap the done edge e if that betters the worse of its two triangles.

    The polygon between the circles is triangulated as it is left over; a swap with what was
    done before chooses the better of the two diagonals, as soon as both are known.
    """
    f = t.adj[e]
    if t.region[e // 3] != DONE or t.region[f // 3] != DONE:
        return
    a, b = t.tri[e], t.tri[f]
    c, d = t.tri[prev_half_edge(e)], t.tri[prev_half_edge(f)]
    xy, size = t.xy, t.size
    old = min(triangle_shape(xy, size, a, b, c), triangle_shape(xy, size, b, a, d))
    if old > GOOD_SHAPE:
        return
    new = min(triangle_shape(xy, size, a, d, c), triangle_shape(xy, size, b, c, d))
    if new > old + 1e-3 and convex(t, e):
        swap(t, e)  # edges a-d and b-c have changed slots: the front may hold them
        if t.region[t.adj[e] // 3] == TODO:
            front.edge[a] = e
        if t.region[t.adj[f] // 3] == TODO:
            front.edge[b] = f


@kernel
def _close(p, a, b):
    """Hand over the outer triangle of a -> b when its apex is a neighbour on the front."""
    t, front = p.t, p.front
    e = t.adj[front.edge[a]]  # b -> a
    apex = t.tri[prev_half_edge(e)]
    if apex == NIL:
        return False
    if apex == front.next[b]:
        t.region[e // 3] = DONE
        link(front, a, apex, next_half_edge(e))
        unlink(front, b)
        _queue(p.heap, p.t.xy, p.where, a, apex)
    elif apex == front.prev[a]:
        t.region[e // 3] = DONE
        link(front, apex, b, prev_half_edge(e))
        unlink(front, a)
        _queue(p.heap, p.t.xy, p.where, apex, b)
    else:
        return False
    p.count[CLOSED] += 1
    f, g = next_half_edge(e), prev_half_edge(e)
    if triangle_shape(t.xy, t.size, t.tri[e], t.tri[f], t.tri[g]) < GOOD_SHAPE:
        _settle(t, front, e)
        _settle(t, front, f)
        _settle(t, front, g)
    return True


@kernel
def _close_first(p, a):
    """Hand over the first outer triangle, going round the front from a, that fills a corner.

    Every pocket between the front and the hull is a polygon and has such an ear.
    """
    front, t = p.front, p.t
    b = a
    while True:
        e = t.adj[front.edge[b]]
        if t.tri[prev_half_edge(e)] == front.next[front.next[b]]:
            return _close(p, b, front.next[b])
        b = front.next[b]
        if b == a:
            return False


@kernel
def _advance(p, background, a, b, forced):
    """One step of the front at a -> b (2.3). Returns False when the edge has to wait.

    ``forced``: all edges wait; do what is valid although it is not good.
    """
    t, front = p.t, p.front
    e = t.adj[front.edge[a]]
    apex = t.tri[prev_half_edge(e)]
    if apex != NIL:
        if apex == front.next[b]:
            if edge_length(t.xy, t.size, a, apex) < CLOSE_BELOW:
                return _close(p, a, b)
        elif apex == front.prev[a]:
            if edge_length(t.xy, t.size, apex, b) < CLOSE_BELOW:
                return _close(p, a, b)
    x, y, h11, h12, h22, close = fit_to_two(t.xy, t.size, p.count, background, a, b)
    p.count[FITS] += 1
    rims, other = _open(t, front, a, b, x, y, h11, h12, h22)
    if rims > 0:
        other, dx, dy = _survey(t, a, b, rims, x, y, h11, h12, h22, OVERLAP)
        if other == NIL:
            if (dx != 0.0 or dy != 0.0) and rim_visible(t, rims, x + dx, y + dy):
                x, y = x + dx, y + dy
                h11, h12, h22 = size_at(background, x, y)
            p.radius[_place(p, a, b, rims, x, y, h11, h12, h22)] = close
            return True
    # pushing out: the support grows from (a, b) to the circle in the way (2.3.3)
    if other != NIL and other != a and other != b:
        x, y, h11, h12, h22, r = fit_to_three(t.xy, t.size, p.count, background, a, b, other, x, y)
        if TANGENT_RANGE[0] < r < TANGENT_RANGE[1]:
            ax, ay, bx, by = t.xy[a, 0], t.xy[a, 1], t.xy[b, 0], t.xy[b, 1]
            if orient(ax, ay, bx, by, x, y) < 0.0:
                rims, other = _open(t, front, a, b, x, y, h11, h12, h22)
                if rims > 0:
                    other, _, _ = _survey(t, a, b, rims, x, y, h11, h12, h22, 0.9 * r)
                    if other == NIL:
                        p.radius[_place(p, a, b, rims, x, y, h11, h12, h22)] = r
                        p.count[TANGENTS] += 1
                        return True
    if _close(p, a, b):
        return True
    if not forced:
        return False
    if apex != NIL:
        return _close_first(p, b)
    # on the hull nothing is in the way but circles that are too near: overlap them
    x, y, h11, h12, h22, close = fit_to_two(t.xy, t.size, p.count, background, a, b)
    rims, _ = _open(t, front, a, b, x, y, h11, h12, h22)
    if rims == 0:
        return False
    p.radius[_place(p, a, b, rims, x, y, h11, h12, h22)] = close
    return True


@kernel
def start_packing(p, background):
    """Three mutually touching circles about the origin (2.3.1)."""
    t, front = p.t, p.front
    x, y = p.where[0], p.where[1]
    h11, h12, h22 = size_at(background, x, y)
    for k in range(3):  # corners of the equilateral triangle of side 1 about the origin
        angle = 2.0 * math.pi * k / 3.0 - 0.5 * math.pi
        cx, cy = math.cos(angle) / math.sqrt(3.0), math.sin(angle) / math.sqrt(3.0)
        t.xy[k, 0] = x + h11 * cx + h12 * cy
        t.xy[k, 1] = y + h12 * cx + h22 * cy
        t.size[k, 0], t.size[k, 1], t.size[k, 2] = size_at(background, t.xy[k, 0], t.xy[k, 1])
        p.radius[k] = 1.0
    if orient(t.xy[0, 0], t.xy[0, 1], t.xy[1, 0], t.xy[1, 1], t.xy[2, 0], t.xy[2, 1]) <= 0.0:
        return BAD_START
    t.count[0] = 3
    t.count[1] = 4
    for k in range(3):
        t.tri[k] = k
        ghost = 3 * (k + 1)  # ghost (b, a, NIL) of the edge a -> b, a = k
        t.tri[ghost] = (k + 1) % 3
        t.tri[ghost + 1] = k
        t.tri[ghost + 2] = NIL
        t.adj[k] = ghost
        t.adj[ghost] = k
        before = 3 * ((k + 2) % 3 + 1)  # ghost of the edge that ends at a: it starts with a
        t.adj[ghost + 1] = before + 2  # a -> NIL meets NIL -> a
        t.adj[before + 2] = ghost + 1
        link(front, k, (k + 1) % 3, k)
    t.region[0] = DONE
    for k in range(1, 4):
        t.region[k] = TODO
    for k in range(3):
        _queue(p.heap, p.t.xy, p.where, k, (k + 1) % 3)
    return FINISHED


@kernel
def pack(p, background):
    """Advance the front until it has left the box or the wanted circles are there (2.4)."""
    t, front, heap, count = p.t, p.front, p.heap, p.count
    room = min(len(t.xy), len(front.next)) - 1
    forced = False
    while True:
        if t.count[0] >= count[WANTED]:
            return FINISHED
        if heap.count[0] == 0:
            if count[PARKED] == 0:
                return FINISHED
            if forced and count[MOVES] == 0:
                return STUCK
            forced = count[MOVES] == 0  # a whole round of waiting edges without a move
            count[FORCED] += 1 if forced else 0
            waiting = count[PARKED]
            count[PARKED] = 0
            count[MOVES] = 0
            for k in range(waiting):
                a, b = p.parked[k, 0], p.parked[k, 1]
                if front.next[a] == b:
                    _queue(p.heap, p.t.xy, p.where, a, b)
            continue
        if t.count[0] >= room or heap.count[0] + 3 >= len(heap.key):
            return FULL
        _, a, b = pop(heap)
        if front.next[a] != b or not _meets_box(t.xy, p.where, a, b):
            continue
        if _advance(p, background, a, b, forced):
            count[MOVES] += 1
            forced = False
            if front.next[a] == b:  # the move was made elsewhere
                _queue(heap, t.xy, p.where, a, b)
        else:
            if count[PARKED] == len(p.parked):
                push(heap, 0.0, a, b)
                return FULL
            p.parked[count[PARKED], 0] = a
            p.parked[count[PARKED], 1] = b
            count[PARKED] += 1
