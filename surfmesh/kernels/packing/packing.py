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

from surfmesh.kernels import NIL
from surfmesh.kernels.fields.background import size_at
from surfmesh.kernels.fields.tensors import edge_length
from surfmesh.kernels.jit import inlined_kernel, kernel
from surfmesh.kernels.packing.circle_fitting import (
    fit_to_three,
    fit_to_two,
    relax_against_neighbours,
)
from surfmesh.kernels.packing.disc_packing import advance_disc
from surfmesh.kernels.packing.front import DONE, TODO, link
from surfmesh.kernels.packing.front_moves import (
    close_corner,
    close_first_corner,
    open_for,
    place,
    queue,
)
from surfmesh.kernels.packing.heap import pop
from surfmesh.kernels.packing.packing_state import (
    FITS,
    FORCED,
    FORCING,
    MOVES,
    PARKED,
    TANGENTS,
    WANTED,
)
from surfmesh.kernels.triangulation.predicates import orient
from surfmesh.kernels.triangulation.triangulation import prev_half_edge, rim_visible

# statuses
FINISHED = 0  # the front has left the box, or the wanted number of circles is reached
FULL = 1  # an array is full: grow it and call again
BAD_START = 2  # no three circles about the origin
GO = -1  # go on
STUCK = 3  # no edge can be advanced, not even badly: cannot happen in exact arithmetic

CLOSE_BELOW = 1.40  # fill a corner a, b, c straight away when l(a, c) is below this
OVERLAP = 0.65  # a circle nearer than this refuses the candidate
TANGENT_RANGE = 0.8, 1.25  # metric radius at which a circle tangent to three is taken


@inlined_kernel
def is_within(xy, where, a, b):
    """Shall the front go on at the segment ab (2.4)?

    It shall when the segment meets the box (separating axes), and its middle lies within the
    largest distance from the origin.
    """
    ax, ay, bx, by = xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1]
    dx, dy = 0.5 * (ax + bx) - where[0], 0.5 * (ay + by) - where[1]
    if dx * dx + dy * dy > where[9]:
        return False
    x0, y0, x1, y1 = where[2], where[3], where[4], where[5]
    if max(ax, bx) < x0 or min(ax, bx) > x1 or max(ay, by) < y0 or min(ay, by) > y1:
        return False
    nx, ny = by - ay, ax - bx
    middle = nx * (0.5 * (x0 + x1) - ax) + ny * (0.5 * (y0 + y1) - ay)
    reach = 0.5 * (abs(nx) * (x1 - x0) + abs(ny) * (y1 - y0))
    return abs(middle) <= reach


@inlined_kernel
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
                return close_corner(p, a, b)
        elif apex == front.prev[a]:
            if edge_length(t.xy, t.size, apex, b) < CLOSE_BELOW:
                return close_corner(p, a, b)
    x, y, h11, h12, h22, close = fit_to_two(t.xy, t.size, p.count, background, a, b)
    p.count[FITS] += 1
    rims, other = open_for(t, front, a, b, x, y, h11, h12, h22)
    if rims > 0:
        other, dx, dy = relax_against_neighbours(t, a, b, rims, x, y, h11, h12, h22, OVERLAP)
        if other == NIL:
            if (dx != 0.0 or dy != 0.0) and rim_visible(t, rims, x + dx, y + dy):
                x, y = x + dx, y + dy
                h11, h12, h22 = size_at(background, x, y)
            v = place(p, a, b, rims, x, y, h11, h12, h22)
            p.radius[v] = close
            return True
    # pushing out: the support grows from (a, b) to the circle in the way (2.3.3)
    if other != NIL and other != a and other != b:
        x, y, h11, h12, h22, r = fit_to_three(t.xy, t.size, p.count, background, a, b, other, x, y)
        if TANGENT_RANGE[0] < r < TANGENT_RANGE[1]:
            ax, ay, bx, by = t.xy[a, 0], t.xy[a, 1], t.xy[b, 0], t.xy[b, 1]
            if orient(ax, ay, bx, by, x, y) < 0.0:
                rims, other = open_for(t, front, a, b, x, y, h11, h12, h22)
                if rims > 0:
                    other, _, _ = relax_against_neighbours(
                        t, a, b, rims, x, y, h11, h12, h22, 0.9 * r
                    )
                    if other == NIL:
                        p.radius[place(p, a, b, rims, x, y, h11, h12, h22)] = 2.0 * r - 1.0
                        p.count[TANGENTS] += 1
                        return True
    if close_corner(p, a, b):
        return True
    if not forced:
        return False
    if apex != NIL:
        return close_first_corner(p, b)
    # on the hull nothing is in the way but circles that are too near: overlap them
    x, y, h11, h12, h22, close = fit_to_two(t.xy, t.size, p.count, background, a, b)
    rims, _ = open_for(t, front, a, b, x, y, h11, h12, h22)
    if rims == 0:
        return False
    p.radius[place(p, a, b, rims, x, y, h11, h12, h22)] = close
    return True


@kernel
def start_packing(p, background):
    """Three circles of the background's sizes, touching each other about the origin (2.3.1)."""
    t = p.t
    x, y = p.where[0], p.where[1]
    h11, h12, h22 = size_at(background, x, y)
    for k in range(3):  # corners of the equilateral triangle of side 1 about the origin
        angle = 2.0 * math.pi * k / 3.0 - 0.5 * math.pi
        cx, cy = math.cos(angle) / math.sqrt(3.0), math.sin(angle) / math.sqrt(3.0)
        t.xy[k, 0] = x + h11 * cx + h12 * cy
        t.xy[k, 1] = y + h12 * cx + h22 * cy
        t.size[k, 0], t.size[k, 1], t.size[k, 2] = size_at(background, t.xy[k, 0], t.xy[k, 1])
        p.radius[k] = 1.0
    return _first_front(p)


@kernel
def start_packing_discs(p):
    """Three circles of the drawn radii, touching each other about the origin (2.3.1)."""
    t = p.t
    ra, rb, rc = p.drawn[0], p.drawn[1], p.drawn[2]
    p0, q0, d = ra + rc, rb + rc, ra + rb
    cx = 0.5 * (d + (p0 - q0) * (p0 + q0) / d)
    cy = math.sqrt(max(p0 * p0 - cx * cx, 0.0))
    for k in range(3):
        x, y = (0.0 if k == 0 else (d if k == 1 else cx)), (cy if k == 2 else 0.0)
        t.xy[k, 0] = p.where[0] + x - (d + cx) / 3.0
        t.xy[k, 1] = p.where[1] + y - cy / 3.0
        t.size[k, 0], t.size[k, 1], t.size[k, 2] = 2.0 * p.drawn[k], 0.0, 2.0 * p.drawn[k]
        p.radius[k] = 1.0
    return _first_front(p)


@kernel
def _first_front(p):
    """The first triangle, its ghosts around it, and its sides as the front."""
    t, front = p.t, p.front
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
        queue(p.heap, p.t.xy, p.where, k, (k + 1) % 3)
    return FINISHED


@inlined_kernel
def _next_edge(p):
    """The edge of the front that is next, as (GO, a, b), or the status with which to stop."""
    t, front, heap, count = p.t, p.front, p.heap, p.count
    room = min(len(t.xy), len(front.next)) - 1
    while True:
        if t.count[0] >= count[WANTED]:
            return FINISHED, NIL, NIL
        if heap.count[0] == 0:
            if count[PARKED] == 0:
                return FINISHED, NIL, NIL
            if count[FORCING] and count[MOVES] == 0:
                return STUCK, NIL, NIL
            # a whole round of waiting edges without a move: what is not good must do
            count[FORCING] = 1 if count[MOVES] == 0 else 0
            count[FORCED] += count[FORCING]
            waiting = count[PARKED]
            count[PARKED] = 0
            count[MOVES] = 0
            for k in range(waiting):
                a, b = p.parked[k, 0], p.parked[k, 1]
                if front.next[a] == b:
                    queue(heap, t.xy, p.where, a, b)
            continue
        if t.count[0] >= room or heap.count[0] + 3 >= len(heap.key):
            return FULL, NIL, NIL
        if count[PARKED] == len(p.parked):
            return FULL, NIL, NIL
        _, a, b = pop(heap)
        if front.next[a] == b and is_within(t.xy, p.where, a, b):
            return GO, a, b


@inlined_kernel
def _noted(p, a, b, moved):
    """The edge a -> b goes back to the queue after a move elsewhere, or waits without one."""
    if moved:
        p.count[MOVES] += 1
        p.count[FORCING] = 0
        if p.front.next[a] == b:
            queue(p.heap, p.t.xy, p.where, a, b)
        return
    p.parked[p.count[PARKED], 0] = a
    p.parked[p.count[PARKED], 1] = b
    p.count[PARKED] += 1


@kernel
def pack(p, background):
    """Advance the front until it has left the box or the wanted circles are there (2.4)."""
    while True:
        status, a, b = _next_edge(p)
        if status != GO:
            return status
        _noted(p, a, b, _advance(p, background, a, b, p.count[FORCING] != 0))


@kernel
def pack_discs(p):
    """The same for circles of drawn radii."""
    while True:
        status, a, b = _next_edge(p)
        if status != GO:
            return status
        _noted(p, a, b, advance_disc(p, a, b, p.count[FORCING] != 0))
