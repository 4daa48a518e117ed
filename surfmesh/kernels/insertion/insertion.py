"""Boundary insertion by tracing neighbours (Wang, Ming and Lo 2007, section 3).

The five steps: identify the segments (the caller hands over nodes and pairs of nodes); insert
the nodes; find the elements that a segment cuts by tracing neighbours and recover it by edge
swaps; improve the quality along the boundary; remove what lies outside, growing from seeds on
the inner side of the segments. No step searches the whole mesh: each starts where the last
one ended.
"""

import math

from surfmesh.kernels import NIL
from surfmesh.kernels.fields.tensors import solve, triangle_shape
from surfmesh.kernels.jit import kernel
from surfmesh.kernels.triangulation.local_operations import (
    DEAD,
    convex,
    orient_vertices,
    remove_vertex,
    rotate_ccw,
    swap,
)
from surfmesh.kernels.triangulation.triangulation import (
    fill_cavity,
    locate,
    next_half_edge,
    open_cavity,
    prev_half_edge,
    side,
)

# statuses
FINISHED = 0
NODE_TAKEN = 1  # a node lies on an earlier node or segment
CROSSING = 2  # a segment crosses an earlier one
SEGMENT_ON_NODE = 3  # a segment runs through a node
NOT_RECOVERED = 4  # swaps did not end
LEAK = 5  # the inside reaches infinity: a loop is open or runs the wrong way

# regions of the finished triangulation
OUTSIDE = 0
INSIDE = 1

MOVE_WITHIN = 0.35  # a vertex nearer than this to a new node becomes that node


@kernel
def corner_of(t, triangle, v):
    """The half-edge of the triangle that starts at v, or NIL."""
    for i in range(3):
        if t.tri[3 * triangle + i] == v:
            return 3 * triangle + i
    return NIL


@kernel
def _can_move(t, e, x, y):
    """May the vertex at the start of e go to (x, y) with its star left positive?"""
    f = e
    while True:
        a, b = t.tri[next_half_edge(f)], t.tri[prev_half_edge(f)]
        if a < 0 or b < 0 or t.fixed[f] != 0 or side(t.xy, a, b, x, y) <= 0.0:
            return False
        f = rotate_ccw(t, f)
        if f == e:
            return True


@kernel
def _new_vertex(t, x, y, h11, h12, h22):
    p = t.count[0]
    t.count[0] = p + 1
    t.xy[p, 0], t.xy[p, 1] = x, y
    t.size[p, 0], t.size[p, 1], t.size[p, 2] = h11, h12, h22
    return p


@kernel
def insert_node(t, start, x, y, h11, h12, h22, first_node):
    """Step 2: make (x, y) a vertex. Vertices from ``first_node`` on are boundary nodes.

    A near vertex becomes the node, otherwise the triangle, or the edge, that holds the point
    is split together with its neighbours. Returns (vertex, a half-edge that leaves it), or
    (NIL, a half-edge near by) when a node or a segment has the place.
    """
    triangle, _ = locate(t, start, x, y, False)
    for i in range(3):
        e = 3 * triangle + i
        v = t.tri[e]
        if v < 0 or v >= first_node:
            continue
        ux, uy = solve(h11, h12, h22, t.xy[v, 0] - x, t.xy[v, 1] - y)
        if ux * ux + uy * uy < MOVE_WITHIN * MOVE_WITHIN and _can_move(t, e, x, y):
            p = _new_vertex(t, x, y, h11, h12, h22)
            f = e
            while True:
                t.tri[f] = p
                f = rotate_ccw(t, f)
                if f == e:
                    return p, e
    rims = 0
    for wide in (True, False):
        if rims == 0:
            rims = open_cavity(t, triangle, x, y, h11, h12, h22, wide)
    if rims == 0:
        return NIL, 3 * triangle
    p = _new_vertex(t, x, y, h11, h12, h22)
    fill_cavity(t, rims, p)
    return p, 3 * t.cavity[0] + 2


@kernel
def _first_cut(t, start, a, b):
    """Turn around a, from half-edge ``start``, for the way to b.

    Returns (FINISHED, e) when e is a -> b; (CROSSING, e) when the segment leaves the star of a
    through e, from its right end to its left one; (SEGMENT_ON_NODE, e) when e points along it.
    """
    xy = t.xy
    e = start
    while True:
        p = t.tri[next_half_edge(e)]
        q = t.tri[prev_half_edge(e)]
        if p == b:
            return FINISHED, e
        if p >= 0:
            s = orient_vertices(xy, a, b, p)
            ahead = (xy[p, 0] - xy[a, 0]) * (xy[b, 0] - xy[a, 0]) + (xy[p, 1] - xy[a, 1]) * (
                xy[b, 1] - xy[a, 1]
            )
            if s == 0.0 and ahead > 0.0:
                return SEGMENT_ON_NODE, e
            if s < 0.0 and q >= 0 and q != b and orient_vertices(xy, a, b, q) > 0.0:
                return CROSSING, next_half_edge(e)
        e = rotate_ccw(t, e)
        if e == start:
            return NOT_RECOVERED, NIL


@kernel
def _trace(t, cut, a, b, queue):
    """Step 3: the edges that a -> b cuts, from ``cut`` on, by tracing neighbours.

    Each runs from its right end to its left end. Returns (status, how many are in ``queue``,
    the half-edge concerned: it starts at the vertex met, or is the fixed edge crossed).
    """
    n = 0
    e = cut
    while True:
        if t.fixed[e] != 0:
            return CROSSING, n, e
        if n == len(queue):
            return NOT_RECOVERED, n, e
        queue[n] = e
        n += 1
        f = t.adj[e]  # left end -> right end
        v = t.tri[prev_half_edge(f)]
        if v == b:
            return FINISHED, n, NIL
        s = orient_vertices(t.xy, a, b, v)
        if s == 0.0:
            return SEGMENT_ON_NODE, n, prev_half_edge(f)
        e = prev_half_edge(f) if s < 0.0 else next_half_edge(f)


@kernel
def _swap_out(t, a, b, queue, count):
    """Step 3: swap the edges in ``queue`` until a-b is an edge (Sloan 1993).

    Returns the half-edge a -> b, or NIL.
    """
    xy = t.xy
    room = len(queue)
    head = 0
    found = NIL
    guard = 64 * count * (count + 16)
    while count > 0 and guard > 0:
        guard -= 1
        e = queue[head % room]
        head += 1
        count -= 1
        if not convex(t, e):
            queue[(head + count) % room] = e
            count += 1
            continue
        f = t.adj[e]
        e1, f1 = next_half_edge(e), next_half_edge(f)
        swap(t, e)
        for k in range(count):  # the edges of slots e1 and f1 have moved to f and e
            g = queue[(head + k) % room]
            if g == e1:
                queue[(head + k) % room] = f
            elif g == f1:
                queue[(head + k) % room] = e
        p, q = t.tri[e1], t.tri[f1]  # the new edge p -> q
        if p == a and q == b:
            found = e1
        elif p == b and q == a:
            found = f1
        elif p != a and p != b and q != a and q != b:
            sp, sq = orient_vertices(xy, a, b, p), orient_vertices(xy, a, b, q)
            if (sp < 0.0) != (sq < 0.0):
                queue[(head + count) % room] = e1
                count += 1
    return found if count == 0 else NIL


@kernel
def recover_segment(t, start, a, b, first_node, queue):
    """Step 3: make a -> b an edge. ``start`` leaves a.

    Interior vertices that lie exactly on the segment are removed. Returns (status, the
    half-edge a -> b or the one concerned).
    """
    e = start
    while True:
        status, e = _first_cut(t, e, a, b)
        if status == FINISHED or status == NOT_RECOVERED:
            return status, e
        count, other = 0, NIL
        if status == SEGMENT_ON_NODE:
            other = t.adj[e]
        else:
            status, count, other = _trace(t, e, a, b, queue)
        if status == FINISHED:
            e = _swap_out(t, a, b, queue, count)
            return (FINISHED, e) if e != NIL else (NOT_RECOVERED, NIL)
        if status != SEGMENT_ON_NODE or t.tri[other] >= first_node:
            return status, other
        live = remove_vertex(t, other)
        if live == NIL:
            return NOT_RECOVERED, other
        triangle, _ = locate(t, live, t.xy[a, 0], t.xy[a, 1], False)
        e = corner_of(t, triangle, a)
        if e == NIL:
            return NOT_RECOVERED, live


@kernel
def insert_boundary(t, node_xy, node_size, segment, vertex, edge, queue, where):
    """Steps 2 and 3: insert all nodes, then recover and fix all segments.

    node_xy (k, 2), node_size (k, 3); segment (s, 2) pairs of nodes. Fills vertex (k,) with the
    nodes' vertices and edge (s,) with the segments' half-edges. ``where[0]`` is the node or
    segment reached, ``where[1]`` the half-edge concerned. Consecutive nodes and segments are
    best near each other. Returns a status.
    """
    first_node = t.count[0]
    near = 0
    while t.region[near // 3] == DEAD:
        near += 3
    for k in range(len(node_xy)):
        where[0] = k
        vertex[k], near = insert_node(
            t, near, node_xy[k, 0], node_xy[k, 1],
            node_size[k, 0], node_size[k, 1], node_size[k, 2], first_node,
        )  # fmt: skip
        where[1] = near
        if vertex[k] == NIL:
            return NODE_TAKEN
    for k in range(len(segment)):
        where[0] = k
        a, b = vertex[segment[k, 0]], vertex[segment[k, 1]]
        triangle, _ = locate(t, near, t.xy[a, 0], t.xy[a, 1], False)
        start = corner_of(t, triangle, a)
        if start == NIL:
            return NOT_RECOVERED
        status, e = recover_segment(t, start, a, b, first_node, queue)
        where[1] = e
        if status != FINISHED:
            return status
        t.fixed[e] = 1
        t.fixed[t.adj[e]] = 1
        near = e
    return FINISHED


@kernel
def find_edge(t, e, near, a, b):
    """The half-edge a -> b: e if it still is, otherwise sought from ``near``."""
    if e != NIL and t.region[e // 3] != DEAD and t.tri[e] == a and t.tri[next_half_edge(e)] == b:
        return e
    triangle, _ = locate(t, near, t.xy[a, 0], t.xy[a, 1], False)
    start = corner_of(t, triangle, a)
    if start == NIL:
        return NIL
    status, e = _first_cut(t, start, a, b)
    return e if status == FINISHED else NIL


@kernel
def find_segments(t, segment, vertex, edge):
    """Bring the segments' half-edges up to date after swaps and removals near by."""
    near = 0
    while t.region[near // 3] == DEAD:
        near += 3
    for k in range(len(segment)):
        edge[k] = find_edge(t, edge[k], near, vertex[segment[k, 0]], vertex[segment[k, 1]])
        if edge[k] == NIL:
            return NOT_RECOVERED
        near = edge[k]
    return FINISHED


@kernel
def grow_inside(t, edge):
    """Step 5: everything connected to the left side of a segment is INSIDE, the rest OUTSIDE.

    ``mark`` serves as the links of a stack of triangles.
    """
    for k in range(t.count[1]):
        if t.region[k] != DEAD:
            t.region[k] = OUTSIDE
    top = NIL
    for k in range(len(edge)):
        seed = edge[k] // 3
        if t.region[seed] == OUTSIDE:
            t.region[seed] = INSIDE
            t.mark[seed] = top
            top = seed
    while top != NIL:
        triangle = top
        top = t.mark[triangle]
        for i in range(3):
            e = 3 * triangle + i
            if t.tri[e] < 0:
                return LEAK
            n = t.adj[e] // 3
            if t.fixed[e] == 0 and t.region[n] == OUTSIDE:
                t.region[n] = INSIDE
                t.mark[n] = top
                top = n
    return FINISHED


@kernel
def label_patches(t, label):
    """Step 5 for many regions: grow a patch from every triangle that has none yet.

    A patch ends at segments. label (triangles,) int32 is filled, NIL for dead slots; ``mark``
    serves as the links of a stack. Returns the number of patches; that of the ghosts is the
    outside of everything.
    """
    for k in range(t.count[1]):
        label[k] = NIL
    patches = 0
    for k in range(t.count[1]):
        if label[k] != NIL or t.region[k] == DEAD:
            continue
        label[k] = patches
        t.mark[k] = NIL
        top = k
        while top != NIL:
            triangle = top
            top = t.mark[triangle]
            for e in range(3 * triangle, 3 * triangle + 3):
                if t.adj[e] < 0 or t.fixed[e] != 0:
                    continue
                n = t.adj[e] // 3
                if label[n] == NIL:
                    label[n] = patches
                    t.mark[n] = top
                    top = n
        patches += 1
    return patches


@kernel
def _distance_to_edge(t, e, v):
    """Metric distance of vertex v from the segment of half-edge e."""
    a, b = t.tri[e], t.tri[next_half_edge(e)]
    xy, size = t.xy, t.size
    h11 = (size[a, 0] + size[b, 0] + 2.0 * size[v, 0]) * 0.25
    h12 = (size[a, 1] + size[b, 1] + 2.0 * size[v, 1]) * 0.25
    h22 = (size[a, 2] + size[b, 2] + 2.0 * size[v, 2]) * 0.25
    ux, uy = solve(h11, h12, h22, xy[b, 0] - xy[a, 0], xy[b, 1] - xy[a, 1])
    vx, vy = solve(h11, h12, h22, xy[v, 0] - xy[a, 0], xy[v, 1] - xy[a, 1])
    s = min(max((ux * vx + uy * vy) / (ux * ux + uy * uy), 0.0), 1.0)
    return math.sqrt((vx - s * ux) ** 2 + (vy - s * uy) ** 2)


@kernel
def clear_boundary(t, segment, vertex, edge, first_node, crowded):
    """Step 4: remove interior vertices nearer than ``crowded`` to a segment or its ends.

    Returns the number removed. Vertices from ``first_node`` on are nodes and stay.
    """
    removed = 0
    for k in range(len(edge)):
        a, b = vertex[segment[k, 0]], vertex[segment[k, 1]]
        e = find_edge(t, edge[k], edge[k - 1], a, b)
        while True:  # the apex over the segment; removing it brings up another
            apex = t.tri[prev_half_edge(e)]
            if apex >= first_node or _distance_to_edge(t, e, apex) >= crowded:
                break
            live = remove_vertex(t, prev_half_edge(e))
            if live == NIL:
                break
            e = find_edge(t, e, live, a, b)
            removed += 1
        f = e
        while True:  # neighbours of a, counter-clockwise up to the next segment
            f = rotate_ccw(t, f)
            if t.fixed[f] != 0:
                break
            v = t.tri[next_half_edge(f)]
            if v < first_node and _distance_to_edge(t, e, v) < crowded:
                live = remove_vertex(t, t.adj[f])
                if live != NIL:
                    removed += 1
                    e = find_edge(t, e, live, a, b)
                    f = e
        edge[k] = e
    return removed


@kernel
def swap_bad(t, shape, below, sweeps):
    """Step 4: swap edges of INSIDE triangles with alpha under ``below`` while that betters them.

    alpha in the metric; ``shape`` (triangles,) is scratch. Returns the swaps made.
    """
    for k in range(t.count[1]):
        shape[k] = 1.0
        if t.region[k] == INSIDE:
            a, b, c = t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2]
            shape[k] = triangle_shape(t.xy, t.size, a, b, c)
    total = 0
    for _ in range(sweeps):
        swaps = 0
        for k in range(t.count[1]):
            for i in range(3):
                e = 3 * k + i
                f = t.adj[e]
                if shape[k] >= below or t.fixed[e] != 0:
                    continue
                a, b = t.tri[e], t.tri[f]
                c, d = t.tri[prev_half_edge(e)], t.tri[prev_half_edge(f)]
                old = min(shape[k], shape[f // 3])
                first = triangle_shape(t.xy, t.size, a, d, c)
                second = triangle_shape(t.xy, t.size, b, c, d)
                if min(first, second) > old + 1e-3 and convex(t, e):
                    swap(t, e)
                    shape[k], shape[f // 3] = first, second
                    swaps += 1
        total += swaps
        if swaps == 0:
            break
    return total
