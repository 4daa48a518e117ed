"""Moves of the front over the triangulation of the plane: place a circle, hand a triangle over."""

from surfmesh.kernels import NIL
from surfmesh.kernels.fields.tensors import triangle_shape
from surfmesh.kernels.jit import inlined_kernel, kernel
from surfmesh.kernels.packing.front import DONE, TODO, link, unlink
from surfmesh.kernels.packing.heap import push
from surfmesh.kernels.packing.packing_state import CLOSED
from surfmesh.kernels.triangulation.local_operations import convex, swap
from surfmesh.kernels.triangulation.triangulation import (
    fill_cavity,
    locate,
    next_half_edge,
    open_cavity,
    prev_half_edge,
)

POCKET = 8  # most circles on the rim of a polygon that is closed without one within
GOOD_SHAPE = 0.8  # a pair of done triangles both better than this is left as it is


@kernel
def queue(heap, xy, where, a, b):
    """Nearest to the origin first (2.2): by the middle of the edge, in the key metric."""
    x = 0.5 * (xy[a, 0] + xy[b, 0]) - where[0]
    y = 0.5 * (xy[a, 1] + xy[b, 1]) - where[1]
    push(heap, where[6] * x * x + 2.0 * where[7] * x * y + where[8] * y * y, a, b)


@kernel
def open_for(t, front, a, b, x, y, h11, h12, h22):
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
def place(p, a, b, rims, x, y, h11, h12, h22):
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
    queue(p.heap, p.t.xy, p.where, a, v)
    queue(p.heap, p.t.xy, p.where, v, b)
    settle(t, p.front, done)
    return v


@kernel
def settle(t, front, e):
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
def close_corner(p, a, b):
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
        queue(p.heap, p.t.xy, p.where, a, apex)
    elif apex == front.prev[a]:
        t.region[e // 3] = DONE
        link(front, apex, b, prev_half_edge(e))
        unlink(front, a)
        queue(p.heap, p.t.xy, p.where, apex, b)
    else:
        return False
    p.count[CLOSED] += 1
    f, g = next_half_edge(e), prev_half_edge(e)
    if triangle_shape(t.xy, t.size, t.tri[e], t.tri[f], t.tri[g]) < GOOD_SHAPE:
        settle(t, front, e)
        settle(t, front, f)
        settle(t, front, g)
    return True


@kernel
def close_first_corner(p, a):
    """Hand over the first outer triangle, going round the front from a, that fills a corner.

    Every pocket between the front and the hull is a polygon and has such an ear.
    """
    front, t = p.front, p.t
    b = a
    while True:
        e = t.adj[front.edge[b]]
        if t.tri[prev_half_edge(e)] == front.next[front.next[b]]:
            return close_corner(p, b, front.next[b])
        b = front.next[b]
        if b == a:
            return False


@inlined_kernel
def steps_between(front, a, b):
    """How many steps along the front lead from a to b, 0 when more than ``POCKET``."""
    for k in range(1, POCKET + 1):
        a = front.next[a]
        if a == b:
            return k
    return 0


@kernel
def close_pocket(p, a, b, steps):
    """Hand over the outer triangles between the front from a to b and the edge a-b.

    a-b is an edge of the outer part, ``steps`` steps of the front apart; the polygon is
    triangulated as the outer part is, ear by ear.
    """
    t, front = p.t, p.front
    while steps > 1:
        v, tried = a, 1
        while t.tri[prev_half_edge(t.adj[front.edge[v]])] != front.next[front.next[v]]:
            v = front.next[v]
            tried += 1
            if tried == steps:
                return False
        close_corner(p, v, front.next[v])
        steps -= 1
    return True
