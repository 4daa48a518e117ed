"""One step of the front when radii are drawn at random (Wang, Ming and Lo 2007, section 2.3).

A circle of the drawn radius is tried on the front edge a -> b. Where it overlaps another, the
largest circle that touches three is tried, then the support is pushed out:

              other                          the support grows from (a, b) to (a, other): the
          P .                                circle P touches both, b is left in the polygon
       /     `  .  other                     a, b, other, P, which is triangulated
      a --- b --- '
"""

from surfmesh.kernels import NIL
from surfmesh.kernels.jit import inlined_kernel, kernel
from surfmesh.kernels.packing.disc_fitting import (
    beside,
    gap_between,
    overlapped,
    touch_three,
    touch_two,
)
from surfmesh.kernels.packing.front_moves import (
    close_corner,
    close_first_corner,
    close_pocket,
    open_for,
    place,
    queue,
    steps_between,
)
from surfmesh.kernels.packing.packing_state import BRUTE, FITS, TANGENTS
from surfmesh.kernels.triangulation.triangulation import (
    locate,
    next_half_edge,
    open_cavity,
    prev_half_edge,
)

TOLERATED = 0.02  # overlap that is let pass, of the sum of the two radii
LOOK_AHEAD = 32  # drawn radii among which one is sought that spans a wide gap
PUSHES = 9  # most circles of the polygon that is left over (2.3.3)
GROWN = 5.0  # a circle may grow by this to touch three, while it stays the smallest of the four
NEARLY = 1.25  # got over drawn radius, or drawn over got, of a circle that touches three
SHRINKS, SHRINK = 24, 0.8  # last resort: smaller circles

MOVED = -2  # the polygon was handed over, its circle is not placed yet


@inlined_kernel
def _draw_one_that_spans(p, a, b):
    """Where the gap between a and b is too wide for the next radius, a later one goes first."""
    least = 0.55 * gap_between(p.t, a, b)
    n = p.t.count[0]
    for k in range(n, min(n + LOOK_AHEAD, len(p.drawn))):
        if p.drawn[k] >= least:
            p.drawn[n], p.drawn[k] = p.drawn[k], p.drawn[n]
            break


@kernel
def _try_disc(p, e, a, b, x, y, r):
    """Place a circle of radius r, supported by a and b, at (x, y) if nothing is in the way.

    e: an outer half-edge between a and b. Returns NIL when placed, else the circle in the way;
    a when there is none but the place cannot be used.
    """
    t, front = p.t, p.front
    other = beside(t, front.prev[a], front.next[b], t.tri[prev_half_edge(e)], x, y, r, TOLERATED)
    if other != NIL and other != a and other != b:
        return other  # most often it is a neighbour on the front: nothing need be opened
    start, barrier = locate(t, e, x, y, True)
    if barrier != NIL:
        v = t.tri[barrier]
        return v if v != a and v != b else t.tri[next_half_edge(barrier)]
    h = 2.0 * r
    rims = open_cavity(t, start, x, y, h, 0.0, h, True)
    if rims == 0:
        return a
    other = overlapped(t, a, b, rims, x, y, r, TOLERATED)
    if other != NIL:
        return other
    base = a  # an edge of the front between a and b that the new circle sees
    while t.mark[t.adj[front.edge[base]] // 3] != t.stamp[0]:
        base = front.next[base]
        if base == b:
            steps = steps_between(front, a, b)
            return MOVED if steps > 1 and close_pocket(p, a, b, steps) else a
    tip = front.next[base]
    v = place(p, base, tip, rims, x, y, h, 0.0, h)
    p.radius[v] = r / p.drawn[v]
    _close_up(p, a, v)
    _close_up(p, v, b)
    return NIL


@inlined_kernel
def _close_up(p, a, b):
    """Hand over the polygon between the front from a to b and the edge a-b, if there is one."""
    steps = steps_between(p.front, a, b)
    if steps > 1:
        close_pocket(p, a, b, steps)


@inlined_kernel
def _grown_to_three(p, e, a, b, wanted):
    """Try the circle that touches a, b and the one across, if that is a little larger (2.2)."""
    t = p.t
    apex = t.tri[prev_half_edge(e)]
    if apex == NIL:
        return False
    x, y, r = touch_three(t, a, b, apex)
    smallest = 0.5 * min(t.size[a, 0], t.size[b, 0], t.size[apex, 0])
    if not wanted < r < min(GROWN * wanted, smallest):
        return False
    found = _try_disc(p, e, a, b, x, y, r)
    p.count[TANGENTS] += found == NIL
    return found == NIL or found == MOVED


@inlined_kernel
def _pushed_out(p, e, a, b, wanted):
    """Fit the circle to a and b; push the support out until nothing overlaps (2.3.3)."""
    t, front = p.t, p.front
    moved = False
    first, last = a, b  # the support (m - q, m + p)
    for _ in range(PUSHES):
        x, y, r = touch_two(t, first, last, wanted)
        p.count[FITS] += 1
        other = _try_disc(p, e, first, last, x, y, r)
        if other == NIL:
            return True
        if other == MOVED:
            moved = True
            e = t.adj[front.edge[first]]
            continue
        if other == first or other == last:
            break
        x, y, r = touch_three(t, first, last, other)
        if wanted < NEARLY * r and r < NEARLY * wanted:
            found = _try_disc(p, e, first, last, x, y, r)
            p.count[TANGENTS] += found == NIL
            if found == NIL or found == MOVED:
                return True
        if steps_between(front, last, other) > 0:
            last = other
        elif steps_between(front, other, first) > 0:
            first = other
        else:
            break
    if moved and front.next[first] == last:
        queue(p.heap, t.xy, p.where, first, last)
    return moved


@inlined_kernel
def _made_to_fit(p, e, a, b, wanted):
    """All edges wait: do what is valid although it is not good."""
    t = p.t
    if close_corner(p, a, b):
        return True
    if t.tri[prev_half_edge(e)] != NIL:
        return close_first_corner(p, b)
    smaller = wanted
    for _ in range(SHRINKS):
        x, y, r = touch_two(t, a, b, smaller)
        found = _try_disc(p, e, a, b, x, y, r)
        if found == NIL or found == MOVED:
            return True
        smaller *= SHRINK
    x, y, r = touch_two(t, a, b, wanted)
    rims, _ = open_for(t, p.front, a, b, x, y, 2.0 * r, 0.0, 2.0 * r)
    if rims == 0:
        return False
    p.count[BRUTE] += 1
    v = place(p, a, b, rims, x, y, 2.0 * r, 0.0, 2.0 * r)
    p.radius[v] = r / p.drawn[v]
    return True


@inlined_kernel
def advance_disc(p, a, b, forced):
    """One step of the front at a -> b. Returns False when the edge has to wait.

    ``forced``: all edges wait.
    """
    t, front = p.t, p.front
    _draw_one_that_spans(p, a, b)
    wanted = p.drawn[t.count[0]]
    e = t.adj[front.edge[a]]
    if _grown_to_three(p, e, a, b, wanted) or _pushed_out(p, e, a, b, wanted):
        return True
    apex = t.tri[prev_half_edge(e)]
    if (apex == front.next[b] and gap_between(t, a, apex) < 2.0 * wanted) or (
        apex == front.prev[a] and gap_between(t, apex, b) < 2.0 * wanted
    ):
        return close_corner(p, a, b)
    return forced and _made_to_fit(p, e, a, b, wanted)
