"""Local changes of a triangulation: swap an edge, remove a vertex. Orientation is kept exactly."""

from surfmesh.kernels import NIL
from surfmesh.kernels.fields.tensors import triangle_shape
from surfmesh.kernels.jit import kernel
from surfmesh.kernels.triangulation.predicates import orient
from surfmesh.kernels.triangulation.triangulation import next_half_edge, prev_half_edge

DEAD = 255  # region of a triangle slot that is no longer used


@kernel
def rotate_ccw(t, e):
    """The next half-edge counter-clockwise around the start of e."""
    return t.adj[prev_half_edge(e)]


@kernel
def orient_vertices(xy, a, b, c):
    """Exact orientation of three vertices."""
    return orient(xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1])


@kernel
def convex(t, e):
    """Can e be swapped: is its quadrilateral strictly convex at both ends of e?"""
    f = t.adj[e]
    if f < 0:
        return False
    a, b = t.tri[e], t.tri[f]
    c, d = t.tri[prev_half_edge(e)], t.tri[prev_half_edge(f)]
    if a < 0 or b < 0 or c < 0 or d < 0:
        return False
    return orient_vertices(t.xy, a, d, c) > 0.0 and orient_vertices(t.xy, b, c, d) > 0.0


@kernel
def swap(t, e):
    """Replace the edge a-b by c-d; the two triangles keep their slots.

          c                       c            before: e a->b, e1 b->c, e2 c->a
        / | \\                   /   \\                  f b->a, f1 a->d, f2 d->b
    e2 /  |  \\ e1           e2 /     \\ f
      /   |   \\               / e1 f1 \\        after:  e a->d, e1 d->c, e2 c->a
     a   e|f   b     to      a --------- b             f b->c, f1 c->d, f2 d->b
      \\   |   /               \\       /
    f1 \\  |  / f2            e \\     / f2      (e runs from a to b; c-d is drawn
        \\ | /                   \\   /           as the level line on the right)
          d                       d
    """
    f = t.adj[e]
    e1, e2 = next_half_edge(e), prev_half_edge(e)
    f1, f2 = next_half_edge(f), prev_half_edge(f)
    c, d = t.tri[e2], t.tri[f2]
    twin_bc, twin_ad = t.adj[e1], t.adj[f1]
    if len(t.fixed) > 0:
        t.fixed[e], t.fixed[f] = t.fixed[f1], t.fixed[e1]
        t.fixed[e1], t.fixed[f1] = 0, 0
    t.tri[e1], t.tri[f1] = d, c
    t.adj[e], t.adj[f] = twin_ad, twin_bc
    if twin_ad >= 0:
        t.adj[twin_ad] = e
    if twin_bc >= 0:
        t.adj[twin_bc] = f
    t.adj[e1], t.adj[f1] = f1, e1


@kernel
def _is_ear(t, n, i):
    """Is the corner after rim vertex i positive, with no other rim vertex in its triangle?"""
    rim, xy = t.rim, t.xy
    p = t.tri[next_half_edge(rim[i])]
    q = t.tri[next_half_edge(rim[(i + 1) % n])]
    r = t.tri[next_half_edge(rim[(i + 2) % n])]
    if orient_vertices(xy, p, q, r) <= 0.0:
        return False
    for k in range(3, n):
        w = t.tri[next_half_edge(rim[(i + k) % n])]
        if (
            orient_vertices(xy, p, q, w) >= 0.0
            and orient_vertices(xy, q, r, w) >= 0.0
            and orient_vertices(xy, r, p, w) >= 0.0
        ):
            return False
    return True


@kernel
def _best_ear(t, n):
    """The ear of best shape of the rim; every simple polygon has one."""
    best, best_shape = NIL, -1.0
    for i in range(n):
        if _is_ear(t, n, i):
            p = t.tri[next_half_edge(t.rim[i])]
            q = t.tri[next_half_edge(t.rim[(i + 1) % n])]
            r = t.tri[next_half_edge(t.rim[(i + 2) % n])]
            shape = triangle_shape(t.xy, t.size, p, q, r)
            if shape > best_shape:
                best, best_shape = i, shape
    return best


@kernel
def _attach(t, e, outer):
    t.adj[e] = outer
    t.adj[outer] = e
    t.fixed[e] = t.fixed[outer]


@kernel
def remove_vertex(t, e):
    """Remove the vertex at the start of e and triangulate its star anew, ear by ear.

    Returns a half-edge of the new triangles, or NIL when the vertex cannot go: its star meets
    the hull or the border, a fixed edge ends there, or there is no room in the scratch. Two
    slots go DEAD.
    """
    n = 0
    f = e
    while True:  # rim[i]: outer twin of the i-th edge of the star; cavity[i]: its triangle
        if t.tri[next_half_edge(f)] < 0 or t.fixed[f] != 0 or n == len(t.rim):
            return NIL
        t.rim[n] = t.adj[next_half_edge(f)]
        if t.rim[n] < 0:
            return NIL
        t.cavity[n] = f // 3
        n += 1
        f = rotate_ccw(t, f)
        if f == e:
            break
    if n < 3:
        return NIL
    slots = n
    while n >= 3:
        i = 0 if n == 3 else _best_ear(t, n)
        j, k = (i + 1) % n, (i + 2) % n
        p = t.tri[next_half_edge(t.rim[i])]
        q = t.tri[next_half_edge(t.rim[j])]
        r = t.tri[next_half_edge(t.rim[k])]
        slots -= 1
        s = 3 * t.cavity[slots]
        t.tri[s], t.tri[s + 1], t.tri[s + 2] = p, q, r
        _attach(t, s, t.rim[i])
        _attach(t, s + 1, t.rim[j])
        if n == 3:
            _attach(t, s + 2, t.rim[k])
        else:
            t.fixed[s + 2] = 0
            t.rim[i] = s + 2
            for m in range(j, n - 1):
                t.rim[m] = t.rim[m + 1]
        n -= 1
        if n == 2:
            break
    for k in range(slots):
        t.region[t.cavity[k]] = DEAD
    return s
