"""A triangulation of the whole plane in flat arrays, with ghost triangles at the hull.

Insertion opens a cavity of triangles around the new point and fills it with a star; walking,
opening and filling never cross a *barrier*: a half-edge between two triangles of different
``region`` (the front), or one that is ``fixed`` (a boundary segment). See kernels/__init__ for
the half-edge convention.
"""

from typing import NamedTuple

import numpy as np

from surfmesh.kernels import NIL
from surfmesh.kernels.fields.tensors import solve
from surfmesh.kernels.jit import inlined_kernel, kernel
from surfmesh.kernels.triangulation.predicates import orient

WALK_LIMIT = 100_000


class Triangulation(NamedTuple):
    xy: np.ndarray  # (vertices, 2) float64
    size: np.ndarray  # (vertices, 3) float64: size tensor H
    tri: np.ndarray  # (3 triangles,) int32 vertices, NIL in a ghost triangle
    adj: np.ndarray  # (3 triangles,) int32 twin half-edges
    region: np.ndarray  # (triangles,) uint8
    fixed: np.ndarray  # (3 triangles,) uint8, or (0,) while there are no segments
    count: np.ndarray  # (2,) int64: vertices, triangles
    mark: np.ndarray  # (triangles,) int32 scratch: number of the search that saw a triangle
    link: np.ndarray  # (vertices + 1,) int32 scratch; the last slot stands for NIL
    cavity: np.ndarray  # (vertices,) int32 scratch: triangles of the cavity
    rim: np.ndarray  # (vertices,) int32 scratch: half-edges around the cavity, seen from inside
    stamp: np.ndarray  # (2,) int64: number of the current search, triangles of the cavity

    @property
    def vertices(self) -> int:
        """How many vertices there are."""
        return int(self.count[0])

    @property
    def triangles(self) -> int:
        """How many triangles there are, dead ones included."""
        return int(self.count[1])


def empty_triangulation(vertices: int) -> Triangulation:
    """Room for ``vertices``: with ghosts there are exactly 2 n - 2 triangles (Euler)."""
    triangles = 2 * vertices + 2
    scratch = min(vertices + 8, 1 << 16)
    return Triangulation(
        xy=np.empty((vertices, 2)),
        size=np.empty((vertices, 3)),
        tri=np.empty(3 * triangles, np.int32),
        adj=np.empty(3 * triangles, np.int32),
        region=np.zeros(triangles, np.uint8),
        fixed=np.zeros(0, np.uint8),
        count=np.zeros(2, np.int64),
        mark=np.zeros(triangles, np.int32),
        link=np.empty(vertices + 1, np.int32),
        cavity=np.empty(scratch, np.int32),
        rim=np.empty(scratch, np.int32),
        stamp=np.zeros(2, np.int64),
    )


@kernel
def next_half_edge(e):
    return e - 2 if e % 3 == 2 else e + 1


@kernel
def prev_half_edge(e):
    return e + 2 if e % 3 == 0 else e - 1


@kernel
def is_barrier(t, e):
    """May no search cross half-edge e?"""
    if t.region[t.adj[e] // 3] != t.region[e // 3]:
        return True
    return len(t.fixed) > 0 and t.fixed[e] != 0


@kernel
def side(xy, a, b, x, y):
    """Exact orientation of (a, b, point); an edge of the hull's infinite vertex sees all."""
    if a < 0 or b < 0:
        return 1.0
    return orient(xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], x, y)


@kernel
def locate(t, start, x, y, stop):
    """Walk from half-edge ``start`` to the triangle of (x, y).

    Returns (triangle, NIL), or (triangle, e) when ``stop`` is set and a barrier e is in the
    way. The order in which the two other edges are tried varies, so that the walk cannot go
    round in circles for ever.
    """
    e = start
    if side(t.xy, t.tri[e], t.tri[next_half_edge(e)], x, y) < 0.0:
        if stop and is_barrier(t, e):
            return e // 3, e
        e = t.adj[e]
    dice = 12345
    for _ in range(WALK_LIMIT):  # the point is on the left of e
        dice = (dice * 1103515245 + 12345) & 0x7FFFFFFF
        onward = NIL
        f = next_half_edge(e) if dice & 0x10000 else prev_half_edge(e)
        for k in range(2):
            if k == 1:
                f = prev_half_edge(e) if dice & 0x10000 else next_half_edge(e)
            if side(t.xy, t.tri[f], t.tri[next_half_edge(f)], x, y) < 0.0:
                onward = f
                break
        if onward == NIL:
            return e // 3, NIL
        if stop and is_barrier(t, onward):
            return e // 3, onward
        e = t.adj[onward]
    return e // 3, e


@kernel
def _in_circle(t, triangle, x, y, h11, h12, h22):
    """Is (x, y) inside the circumcircle of the triangle, seen in the metric of H?

    The circumcircle of a ghost is the open half plane beyond its hull edge.
    """
    e = 3 * triangle
    a, b, c = t.tri[e], t.tri[e + 1], t.tri[e + 2]
    if a < 0:
        return side(t.xy, b, c, x, y) > 0.0
    if b < 0:
        return side(t.xy, c, a, x, y) > 0.0
    if c < 0:
        return side(t.xy, a, b, x, y) > 0.0
    ax, ay = solve(h11, h12, h22, t.xy[a, 0] - x, t.xy[a, 1] - y)
    bx, by = solve(h11, h12, h22, t.xy[b, 0] - x, t.xy[b, 1] - y)
    cx, cy = solve(h11, h12, h22, t.xy[c, 0] - x, t.xy[c, 1] - y)
    det = (
        (ax * ax + ay * ay) * (bx * cy - cx * by)
        - (bx * bx + by * by) * (ax * cy - cx * ay)
        + (cx * cx + cy * cy) * (ax * by - bx * ay)
    )
    return det > 0.0


@inlined_kernel
def open_cavity(t, start, x, y, h11, h12, h22, wide):
    """Collect the triangles to remove for a new vertex at (x, y), which lies in ``start``.

    With ``wide`` the cavity holds the triangles whose metric circumcircle contains the point
    (Bowyer-Watson), otherwise only what the point's place demands. Only triangles of the
    region of ``start`` take part. Returns the number of half-edges on the rim, or 0 when the
    rim is not wholly visible from the point (judged exactly).
    """
    stamp = t.stamp[0] + 1
    t.stamp[0] = stamp
    room = len(t.cavity)
    t.cavity[0] = start
    t.mark[start] = stamp
    cavities = 1
    k = 0
    while k < cavities:
        base = 3 * t.cavity[k]
        k += 1
        for i in range(3):
            e = base + i
            twin = t.adj[e]
            n = twin // 3
            if t.mark[n] == stamp or is_barrier(t, e):
                continue
            a = t.tri[e]
            b = t.tri[next_half_edge(e)]
            on_edge = side(t.xy, a, b, x, y) == 0.0
            if not on_edge and not (wide and _in_circle(t, n, x, y, h11, h12, h22)):
                continue
            z = t.tri[prev_half_edge(twin)]
            sees = on_edge or (side(t.xy, a, z, x, y) > 0.0 and side(t.xy, z, b, x, y) > 0.0)
            if sees and cavities < room:
                t.mark[n] = stamp
                t.cavity[cavities] = n
                cavities += 1
    t.stamp[1] = cavities
    rims = 0
    for k in range(cavities):
        base = 3 * t.cavity[k]
        for i in range(3):
            e = base + i
            if t.mark[t.adj[e] // 3] == stamp:
                continue
            a = t.tri[e]
            b = t.tri[next_half_edge(e)]
            if side(t.xy, a, b, x, y) <= 0.0 or rims == room:
                return 0
            t.rim[rims] = e
            rims += 1
    return rims if rims == cavities + 2 else 0


@kernel
def rim_visible(t, rims, x, y):
    """May the open cavity be filled from (x, y) instead of the point it was opened for?

    The whole rim must be visible. Where the cavity holds ghosts, the hull must stay convex:
    at the new vertex, and at its two new neighbours, whose next hull edges stay hidden.
    """
    first, last = NIL, NIL  # the hull would run first -> new vertex -> last
    for k in range(rims):
        e = t.rim[k]
        a, b = t.tri[e], t.tri[next_half_edge(e)]
        if a >= 0 and b >= 0:
            if side(t.xy, a, b, x, y) <= 0.0:
                return False
            continue
        if b < 0:
            first = a
        else:
            last = b
        ghost = t.adj[e]  # the next ghost along the hull
        f = next_half_edge(ghost) if t.tri[ghost] < 0 else prev_half_edge(ghost)
        if side(t.xy, t.tri[f], t.tri[next_half_edge(f)], x, y) > 0.0:
            return False
    return first == NIL or side(t.xy, last, first, x, y) > 0.0


@inlined_kernel
def fill_cavity(t, rims, p):
    """Replace the open cavity by the star of vertex p; the triangle on rim i is ``cavity[i]``.

    The triangle on rim edge x -> y becomes (x, y, p); each keeps the region of the cavity.
    """
    cavities = t.stamp[1]
    region = t.region[t.cavity[0]]
    fresh = t.count[1]
    for k in range(cavities, rims):
        t.cavity[k] = fresh
        fresh += 1
    t.count[1] = fresh
    for k in range(rims):  # read the rim before its triangles are overwritten
        e = t.rim[k]
        t.rim[k] = t.adj[e]
        t.link[t.tri[e]] = k
    _write_star(t, rims, p, region)


@inlined_kernel
def _write_star(t, rims, p, region):
    """Second half of ``fill_cavity``: ``rim`` now holds the outer twins.

    A twin lies outside the cavity, hence its own end points are still readable.
    """
    for k in range(rims):
        outer = t.rim[k]
        triangle = t.cavity[k]
        x = t.tri[next_half_edge(outer)]
        y = t.tri[outer]
        e = 3 * triangle
        t.tri[e] = x
        t.tri[e + 1] = y
        t.tri[e + 2] = p
        t.adj[e] = outer
        t.adj[outer] = e
        if len(t.fixed) > 0:
            t.fixed[e] = t.fixed[outer]
            t.fixed[e + 1] = 0
            t.fixed[e + 2] = 0
        t.region[triangle] = region
        t.mark[triangle] = 0
    for k in range(rims):  # (x, y, p): its edge y -> p meets the triangle that starts at y
        e = 3 * t.cavity[k]
        after = 3 * t.cavity[t.link[t.tri[e + 1]]]
        t.adj[e + 1] = after + 2
        t.adj[after + 2] = e + 1
