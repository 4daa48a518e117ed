"""The row of vertices along a boundary, where equilateral triangles over its segments have them.

      o     o     o     <- apexes; at a corner two of them become one
     / \\   / \\   / \\
    a --- b --- c --- d    segments, the inside on their left

The packing knows nothing of the boundary, and what is left between the two is irregular. With
this row the misfit lies one row inside, where vertices can move to share it.
"""

from surfmesh.kernels import NIL
from surfmesh.kernels.fields.tensors import solve
from surfmesh.kernels.insertion.insertion import corner_of, insert_node
from surfmesh.kernels.jit import kernel
from surfmesh.kernels.triangulation.local_operations import (
    DEAD,
    orient_vertices,
    remove_vertex,
    rotate_ccw,
)
from surfmesh.kernels.triangulation.triangulation import locate, next_half_edge, prev_half_edge


@kernel
def _distance2(t, v, x, y, h11, h12, h22):
    """Squared metric length from vertex v to a point with its size tensor."""
    ux, uy = solve(
        0.5 * (t.size[v, 0] + h11), 0.5 * (t.size[v, 1] + h12), 0.5 * (t.size[v, 2] + h22),
        t.xy[v, 0] - x, t.xy[v, 1] - y,
    )  # fmt: skip
    return ux * ux + uy * uy


@kernel
def _move_half_way(t, e, x, y):
    """Move the vertex at the start of e half the way to (x, y), if its star stays positive."""
    v = t.tri[e]
    old_x, old_y = t.xy[v, 0], t.xy[v, 1]
    t.xy[v, 0], t.xy[v, 1] = 0.5 * (old_x + x), 0.5 * (old_y + y)
    f = e
    while True:
        a, b = t.tri[next_half_edge(f)], t.tri[prev_half_edge(f)]
        if a < 0 or b < 0 or orient_vertices(t.xy, v, a, b) <= 0.0:
            t.xy[v, 0], t.xy[v, 1] = old_x, old_y
            return
        f = rotate_ccw(t, f)
        if f == e:
            return


@kernel
def _joined(t, triangle, x, y, h11, h12, h22, first, apart):
    """The half-edge from an earlier vertex of the row near by, moved towards this place; or NIL."""
    for i in range(6):
        e = 3 * triangle + i % 3
        if i >= 3:
            if t.adj[e] < 0:
                continue
            e = prev_half_edge(t.adj[e])
        v = t.tri[e]
        if v >= first and _distance2(t, v, x, y, h11, h12, h22) < apart * apart:
            _move_half_way(t, e, x, y)
            return e
    return NIL


@kernel
def _clear_around(t, e, first, crowded):
    """Remove the vertices before ``first`` next to the start of e that are too near.

    Returns a half-edge that starts there.
    """
    p = t.tri[e]
    x, y = t.xy[p, 0], t.xy[p, 1]
    start = e
    while True:
        w = t.tri[next_half_edge(e)]
        live = NIL
        if 0 <= w < first and (
            _distance2(t, w, x, y, t.size[p, 0], t.size[p, 1], t.size[p, 2]) < crowded * crowded
        ):
            live = remove_vertex(t, t.adj[e])
        if live == NIL:
            e = rotate_ccw(t, e)
            if e == start:
                return e
        else:
            triangle, _ = locate(t, live, x, y, False)
            start = e = corner_of(t, triangle, p)
            if e == NIL:
                return live


@kernel
def insert_row(t, apex, apex_size, apart, crowded):
    """Insert the apexes (k, 2), with size tensors (k, 3), and clear the packing around them.

    Apexes nearer than ``apart`` to an earlier one are joined to it; vertices of the packing
    nearer than ``crowded`` are removed. Returns the number of the first new vertex.
    """
    first = t.count[0]
    near = 0
    for k in range(len(apex)):
        x, y = apex[k, 0], apex[k, 1]
        h11, h12, h22 = apex_size[k, 0], apex_size[k, 1], apex_size[k, 2]
        while t.region[near // 3] == DEAD:
            near += 3
        triangle, _ = locate(t, near, x, y, False)
        e = _joined(t, triangle, x, y, h11, h12, h22, first, apart)
        if e == NIL:
            p, e = insert_node(t, 3 * triangle, x, y, h11, h12, h22, first)
            if p == NIL:
                near = e
                continue
        near = _clear_around(t, e, first, crowded)
    return first
