"""Optimisation of a triangulated domain: swaps, smoothing, collapse and split.

Lengths and shapes are measured in space (see kernels.optimisation.surface_frames); what is
allowed is decided exactly in the plane: every triangle stays positively oriented. Vertices on the
border, and on fixed edges, do not move.
"""

import math

from surfmesh.kernels import NIL
from surfmesh.kernels.fields.background import scalar_size_at
from surfmesh.kernels.fields.tensors import solve
from surfmesh.kernels.jit import kernel
from surfmesh.kernels.optimisation.surface_frames import (
    chord,
    edge_length,
    is_anisotropic,
    lift,
    rise,
    shorten,
    triangle_deviation,
    triangle_shape,
)
from surfmesh.kernels.triangulation.local_operations import (
    DEAD,
    convex,
    orient_vertices,
    remove_vertex,
    rotate_ccw,
    swap,
)
from surfmesh.kernels.triangulation.triangulation import next_half_edge, prev_half_edge

SWAP_GAIN = 1e-3  # smallest betterment of the worse alpha for which an edge is swapped
LEAST_SHAPE = 0.6  # a move may lower the worst alpha of a star, but not below this
LONGEST_STEP = 0.3  # of the wanted edge length
SMALLEST_SHRINK = 0.85  # least factor by which one round lowers a wanted size
SMALLEST_SCALE = 0.6  # what is not near enough with sizes scaled by this needs another field
STILL = 0.02  # a vertex that moves less than this (unit lengths) leaves its neighbours alone


@kernel
def find_stars(t, star, frozen, degree):
    """For each vertex a half-edge that leaves it, whether it may move, its triangles."""
    for v in range(t.count[0]):
        star[v] = NIL
        frozen[v] = 0
        degree[v] = 0
    for k in range(t.count[1]):
        if t.region[k] == DEAD:
            continue
        for i in range(3):
            e = 3 * k + i
            v = t.tri[e]
            star[v] = e
            degree[v] += 1
            if t.adj[e] < 0 or t.fixed[e] != 0:
                frozen[v] = 1
                frozen[t.tri[next_half_edge(e)]] = 1


@kernel
def _touches(t, k, flags):
    """Has triangle k a corner that is flagged?"""
    return flags[t.tri[3 * k]] or flags[t.tri[3 * k + 1]] or flags[t.tri[3 * k + 2]]


@kernel
def swap_for_shape(t, s, shape, dirty, active, good, sweeps):
    """Swap edges while that raises the smaller alpha of the pair. Returns the swaps made.

    ``shape`` (triangles,) keeps alpha from call to call; only triangles with a ``dirty``
    corner are measured again and looked at, and of these only those below ``good``. Vertices
    of swapped edges become active.
    """
    for k in range(t.count[1]):
        if t.region[k] != DEAD and _touches(t, k, dirty):
            shape[k] = triangle_shape(s, t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2])
    total = 0
    for _ in range(sweeps):
        swaps = 0
        for k in range(t.count[1]):
            if shape[k] > good or t.region[k] == DEAD or not _touches(t, k, dirty):
                continue
            for e in range(3 * k, 3 * k + 3):
                f = t.adj[e]
                if f < 0 or t.fixed[e] != 0:
                    continue
                a, b = t.tri[e], t.tri[f]
                c, d = t.tri[prev_half_edge(e)], t.tri[prev_half_edge(f)]
                old = min(shape[k], shape[f // 3])
                first = triangle_shape(s, a, d, c)
                second = triangle_shape(s, b, c, d)
                if min(first, second) > old + SWAP_GAIN and _may_swap(t, s, e):
                    swap(t, e)
                    shape[k], shape[f // 3] = first, second
                    active[a] = active[b] = active[c] = active[d] = 1
                    dirty[a] = dirty[b] = dirty[c] = dirty[d] = 1
                    swaps += 1
        total += swaps
        if swaps == 0:
            break
    for v in range(t.count[0]):
        dirty[v] = 0
    return total


@kernel
def swap_for_degree(t, s, frozen, degree, dirty, active, least):
    """Swap edges that bring the degrees of their four vertices nearer to six.

    A 7-7 edge between two 5s is the whole of a pair of dislocations: swapping it leaves four
    regular vertices, and the smoothing that follows a regular patch. Only where the new
    triangles are better than ``least``.
    """
    swaps = 0
    for e in range(3 * t.count[1]):
        f = t.adj[e]
        if f <= e or t.fixed[e] != 0 or t.region[e // 3] == DEAD:
            continue
        a, b = t.tri[e], t.tri[f]
        if degree[a] + degree[b] < 13:
            continue
        c, d = t.tri[prev_half_edge(e)], t.tri[prev_half_edge(f)]
        if degree[a] + degree[b] - degree[c] - degree[d] < 3:
            continue
        if frozen[a] or frozen[b] or frozen[c] or frozen[d]:
            continue
        if triangle_shape(s, a, d, c) > least and triangle_shape(s, b, c, d) > least:
            if _may_swap(t, s, e):
                swap(t, e)
                degree[a] -= 1
                degree[b] -= 1
                degree[c] += 1
                degree[d] += 1
                active[a] = active[b] = active[c] = active[d] = 1
                dirty[a] = dirty[b] = dirty[c] = dirty[d] = 1
                swaps += 1
    return swaps


@kernel
def _coincide(s, p, q):
    """Are p and q one point in space, like the nodes of a side that is a pole?"""
    a = s.point
    return a[p, 0] == a[q, 0] and a[p, 1] == a[q, 1] and a[p, 2] == a[q, 2]


@kernel
def _follows(t, s, v, p):
    """Does the chord from v to p run as the edge in the plane does?

    It does not when the edge goes round a closed surface and the chord takes the short cut.
    Nothing can be said at a degenerate point.
    """
    regular = s.normal[p, 0] != 0.0 or s.normal[p, 1] != 0.0 or s.normal[p, 2] != 0.0
    if not regular:
        return True
    x, y = chord(s, v, p)
    px, py = solve(
        t.size[v, 0], t.size[v, 1], t.size[v, 2], t.xy[p, 0] - t.xy[v, 0], t.xy[p, 1] - t.xy[v, 1]
    )
    along = x * px + y * py
    return along > 0.0 and px * px + py * py < 16.0 * (x * x + y * y)


@kernel
def _may_swap(t, s, e):
    """Is the swap of e valid in the plane, and the new edge short in the plane as in space?"""
    if not convex(t, e):
        return False
    c, d = t.tri[prev_half_edge(e)], t.tri[prev_half_edge(t.adj[e])]
    return _follows(t, s, c, d) and _follows(t, s, d, c)


@kernel
def _newton_step(t, s, v, start, stiffness):
    """The step of v, in its unit tangent plane, that lowers the energy of its star.

    E = sum over triangles of (1 / alpha)^2 / 2 + stiffness * sum over edges of (l - 1)^2: the
    first term is a barrier against bad shape, the second asks for unit edges. One Newton step
    with the exact gradient and a positive definite Hessian. Returns (step, worst alpha).
    """
    gx = gy = a11 = a12 = a22 = 0.0
    worst = 1.0
    e = start
    px, py = chord(s, v, t.tri[next_half_edge(e)])
    while True:
        p, q = t.tri[next_half_edge(e)], t.tri[prev_half_edge(e)]
        qx, qy = chord(s, v, q)
        if _coincide(s, p, q):  # will collapse: neither shape nor a second edge
            e = rotate_ccw(t, e)
            if e == start:
                break
            continue
        area = px * qy - py * qx  # twice the area
        total = 2.0 * (px * px + py * py + qx * qx + qy * qy - px * qx - py * qy)
        if area <= 0.0:
            return 0.0, 0.0, -1.0
        i = 1.0 / area
        f = 0.28867513459481287 * total * i  # 1 / alpha = total / (2 sqrt 3 area)
        worst = min(worst, 1.0 / f)
        tx, ty = -2.0 * (px + qx), -2.0 * (py + qy)  # gradient of total
        rx, ry = py - qy, qx - px  # gradient of area
        c = 0.28867513459481287 * i * f
        gx += c * (tx - total * rx * i)
        gy += c * (ty - total * ry * i)
        a11 += c * (4.0 - 2.0 * tx * rx * i + 2.0 * total * rx * rx * i * i)
        a12 += c * (-(tx * ry + ty * rx) * i + 2.0 * total * rx * ry * i * i)
        a22 += c * (4.0 - 2.0 * ty * ry * i + 2.0 * total * ry * ry * i * i)
        d = math.sqrt(px * px + py * py)
        if is_anisotropic(s):  # the size of p, in this direction, in units of that of v
            bx, by = chord(s, p, v)
            scale = 0.5 * (1.0 + d / max(math.sqrt(bx * bx + by * by), 1e-3 * d))
        else:
            scale = 0.5 * (1.0 + s.size[p] / s.size[v])
        l = d / scale
        nx, ny = px / d, py / d
        k = 2.0 * stiffness / (scale * scale)
        across = max(k * (l - 1.0) / l, 0.0)
        gx -= k * scale * (l - 1.0) * nx
        gy -= k * scale * (l - 1.0) * ny
        a11 += k * nx * nx + across * ny * ny
        a12 += (k - across) * nx * ny
        a22 += k * ny * ny + across * nx * nx
        px, py = qx, qy
        e = rotate_ccw(t, e)
        if e == start:
            break
    det = a11 * a22 - a12 * a12
    if not det > 0.0:
        return 0.0, 0.0, worst
    x = -(a22 * gx - a12 * gy) / det
    y = -(a11 * gy - a12 * gx) / det
    step = math.sqrt(x * x + y * y)
    if step > LONGEST_STEP:
        x *= LONGEST_STEP / step
        y *= LONGEST_STEP / step
    return x, y, worst


@kernel
def _worst_in_star(t, s, v, start):
    """Smallest alpha around v, or -1 when a triangle is not positively oriented."""
    worst = 1.0
    e = start
    while True:
        p, q = t.tri[next_half_edge(e)], t.tri[prev_half_edge(e)]
        if orient_vertices(t.xy, v, p, q) <= 0.0:
            return -1.0
        if not _coincide(s, p, q):
            worst = min(worst, triangle_shape(s, v, p, q))
        e = rotate_ccw(t, e)
        if e == start:
            return worst


@kernel
def smooth(t, s, background, star, frozen, active, dirty, stiffness, moved):
    """Move every active vertex by one Newton step. Fills ``moved`` and returns how many did.

    A move that would turn a triangle over, or make a bad star worse, is not made. In space the
    vertex moves along its tangent plane: the caller puts it back on the surface. Vertices that
    have moved noticeably, and their neighbours, stay active.
    """
    count = 0
    for v in range(t.count[0]):
        start = star[v]
        if active[v] == 0 or frozen[v] != 0 or start == NIL:
            continue
        active[v] = 0
        dx, dy, old = _newton_step(t, s, v, start, stiffness)
        step = dx * dx + dy * dy
        if step < 1e-8:
            continue
        x, y = t.xy[v, 0], t.xy[v, 1]
        x3, y3, z3 = s.point[v, 0], s.point[v, 1], s.point[v, 2]
        t.xy[v, 0] = x + t.size[v, 0] * dx + t.size[v, 1] * dy
        t.xy[v, 1] = y + t.size[v, 1] * dx + t.size[v, 2] * dy
        step3 = lift(s, v, dx, dy)
        for i in range(3):
            s.point[v, i] += step3[i]
        worst = _worst_in_star(t, s, v, start)
        if worst < old and worst < LEAST_SHAPE:
            t.xy[v, 0], t.xy[v, 1] = x, y
            s.point[v, 0], s.point[v, 1], s.point[v, 2] = x3, y3, z3
            continue
        s.size[v] = s.scale[v] * scalar_size_at(background, t.xy[v, 0], t.xy[v, 1])
        moved[count] = v
        count += 1
        dirty[v] = 1
        if step > STILL * STILL:
            active[v] = 1
            e = start
            while True:
                active[t.tri[next_half_edge(e)]] = 1
                e = rotate_ccw(t, e)
                if e == start:
                    break
    return count


@kernel
def estimate_deviations(t, s, error):
    """Second-order estimate of each triangle's distance from the surface -> error (triangles,)."""
    for k in range(t.count[1]):
        error[k] = 0.0
        if t.region[k] != DEAD:
            error[k] = triangle_deviation(s, t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2])


@kernel
def shrink(t, s, triangles, error, chord_error, active):
    """Ask for smaller edges where triangles (n,) are farther away (n,) than ``chord_error``.

    The sizes of their corners are scaled by what deviation, of second order in the size,
    needs. Returns the number of such triangles.
    """
    far = 0
    for k in range(len(triangles)):
        if error[k] <= chord_error:
            continue
        far += 1
        factor = max(math.sqrt(chord_error / error[k]), SMALLEST_SHRINK)
        for i in range(3):
            v = t.tri[3 * triangles[k] + i]
            if s.scale[v] * factor >= SMALLEST_SCALE:
                shorten(s, v, factor)
            active[v] = 1
    return far


@kernel
def find_folded(t, s, least, at_apex, folded):
    """Mark in ``folded`` (triangles,) those turned against the surface at one of their corners.

    ``least``: cosine of the largest angle allowed between the normals; ``at_apex``: the same
    for a triangle that ends at a pole or an apex, where the surface has no normal: around the
    apex of a cone it turns by as much as a right angle at any size. Returns how many.
    """
    count = 0
    p = s.point
    for k in range(t.count[1]):
        folded[k] = 0
        if t.region[k] == DEAD:
            continue
        a, b, c = t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2]
        if _coincide(s, a, b) or _coincide(s, b, c) or _coincide(s, c, a):
            continue
        ux, uy, uz = p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]
        vx, vy, vz = p[c, 0] - p[a, 0], p[c, 1] - p[a, 1], p[c, 2] - p[a, 2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        area = math.sqrt(nx * nx + ny * ny + nz * nz)
        worst, regular = area, True
        for i in range(3):
            m = s.normal[t.tri[3 * k + i]]
            if m[0] == 0.0 and m[1] == 0.0 and m[2] == 0.0:
                regular = False
            else:
                worst = min(worst, nx * m[0] + ny * m[1] + nz * m[2])
        if worst < (least if regular else at_apex) * area:
            folded[k] = 1
            count += 1
    return count


@kernel
def triangles_at(t, vertices, seen):
    """Mark in ``seen`` (triangles,) the triangles with a corner marked in ``vertices``."""
    for k in range(t.count[1]):
        seen[k] = 0
        if t.region[k] != DEAD:
            for i in range(3):
                if vertices[t.tri[3 * k + i]] != 0:
                    seen[k] = 1


@kernel
def activate_bad(t, s, least, active):
    """Make the corners of triangles with alpha below ``least`` active; returns how many."""
    bad = 0
    for k in range(t.count[1]):
        if t.region[k] == DEAD:
            continue
        a, b, c = t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2]
        if _coincide(s, a, b) or _coincide(s, b, c) or _coincide(s, c, a):
            continue
        if triangle_shape(s, a, b, c) < least:
            bad += 1
            for i in range(3):
                active[t.tri[3 * k + i]] = 1
    return bad


@kernel
def collapse_short(t, s, star, frozen, degree, dirty, active, shortest, few):
    """Remove interior vertices with an edge below ``shortest`` or with at most ``few`` triangles.

    Returns how many were removed; stars must be found anew afterwards.
    """
    removed = 0
    for v in range(t.count[0]):
        start = star[v]
        if start == NIL or frozen[v] != 0:
            continue
        if active[v] == 2:  # a neighbour has just gone
            continue
        short = degree[v] <= few
        e = start
        while not short:
            short = edge_length(s, v, t.tri[next_half_edge(e)]) < shortest
            e = rotate_ccw(t, e)
            if e == start:
                break
        if not short:
            continue
        e = start
        while True:  # their half-edges become stale: leave them for the next round
            active[t.tri[next_half_edge(e)]] = 2
            e = rotate_ccw(t, e)
            if e == start:
                break
        if remove_vertex(t, start) != NIL:
            star[v] = NIL
            removed += 1
    for v in range(t.count[0]):
        if active[v] == 2:
            active[v] = 1
            dirty[v] = 1
    return removed


@kernel
def split_edge(t, e, x, y):
    """Put a vertex at (x, y), on or near the interior edge e, and join it to four corners.

            c                      c
           / \\                    /|\\          (a, b, c) -> (a, p, c) in its slot, (p, b, c)
          / e \\                  / | \\
         a-----b      ->        a--p--b
          \\ f /                  \\ | /          (b, a, d) -> (b, p, d) in its slot, (p, a, d)
           \\ /                    \\|/
            d                      d

    Returns the vertex, or NIL when a triangle would not be positive or there is no room.
    """
    f = t.adj[e]
    p = t.count[0]
    k = t.count[1]
    if p >= len(t.xy) or 3 * (k + 2) > len(t.tri):
        return NIL
    e1, f1 = next_half_edge(e), next_half_edge(f)
    a, b, c, d = t.tri[e], t.tri[f], t.tri[prev_half_edge(e)], t.tri[prev_half_edge(f)]
    t.xy[p, 0], t.xy[p, 1] = x, y
    if (
        orient_vertices(t.xy, a, p, c) <= 0.0
        or orient_vertices(t.xy, p, b, c) <= 0.0
        or orient_vertices(t.xy, b, p, d) <= 0.0
        or orient_vertices(t.xy, p, a, d) <= 0.0
    ):
        return NIL
    t.count[0] = p + 1
    t.count[1] = k + 2
    g = 3 * k  # (p, b, c)
    h = g + 3  # (p, a, d)
    twin_bc, twin_ad = t.adj[e1], t.adj[f1]
    t.region[k] = t.region[e // 3]
    t.region[k + 1] = t.region[f // 3]
    t.tri[g], t.tri[g + 1], t.tri[g + 2] = p, b, c
    t.tri[h], t.tri[h + 1], t.tri[h + 2] = p, a, d
    t.tri[e1] = p  # e: a -> p, e1: p -> c
    t.tri[f1] = p  # f: b -> p, f1: p -> d
    t.adj[e], t.adj[h] = h, e  # a -> p meets p -> a
    t.adj[f], t.adj[g] = g, f  # b -> p meets p -> b
    t.adj[e1], t.adj[g + 2] = g + 2, e1  # p -> c meets c -> p
    t.adj[f1], t.adj[h + 2] = h + 2, f1  # p -> d meets d -> p
    t.adj[g + 1] = twin_bc
    if twin_bc >= 0:
        t.adj[twin_bc] = g + 1
    t.adj[h + 1] = twin_ad
    if twin_ad >= 0:
        t.adj[twin_ad] = h + 1
    t.fixed[g + 1], t.fixed[h + 1] = t.fixed[e1], t.fixed[f1]
    t.fixed[g] = t.fixed[g + 2] = t.fixed[h] = t.fixed[h + 2] = 0
    t.fixed[e1] = t.fixed[f1] = 0
    return p


@kernel
def split_long(t, s, longest, dirty, active):
    """Split interior edges of active vertices longer than ``longest``.

    Returns the first of the new vertices. The caller embeds them; until then they lie in the
    middle of their chords.
    """
    first = t.count[0]
    for e in range(3 * t.count[1]):
        a = t.tri[e]
        f = t.adj[e]
        if a >= first or f <= e or t.fixed[e] != 0 or t.region[e // 3] == DEAD:
            continue
        b = t.tri[f]
        if active[a] == 0 and active[b] == 0:
            continue
        if b >= first or edge_length(s, a, b) <= longest:
            continue
        _halve(t, s, e, active, dirty)
    return first


@kernel
def _halve(t, s, e, active, dirty):
    """Split the edge e in the middle; what is known at the new vertex is taken from its ends."""
    a, b = t.tri[e], t.tri[t.adj[e]]
    p = split_edge(t, e, 0.5 * (t.xy[a, 0] + t.xy[b, 0]), 0.5 * (t.xy[a, 1] + t.xy[b, 1]))
    if p == NIL:
        return p
    for i in range(3):
        s.point[p, i] = 0.5 * (s.point[a, i] + s.point[b, i])
        s.tangent_map[p, 0, i] = s.tangent_map[a, 0, i]
        s.tangent_map[p, 1, i] = s.tangent_map[a, 1, i]
        s.normal[p, i] = s.normal[a, i]
        t.size[p, i] = t.size[a, i]
    s.scale[p] = 0.5 * (s.scale[a] + s.scale[b])
    s.size[p] = 0.5 * (s.size[a] + s.size[b])
    if is_anisotropic(s):
        for i in range(6):
            s.metric_root_3d[p, i] = 0.5 * (s.metric_root_3d[a, i] + s.metric_root_3d[b, i])
    active[p] = active[a] = active[b] = 1
    dirty[p] = dirty[a] = dirty[b] = 1
    return p


@kernel
def split_far(t, s, triangles, dirty, active):
    """Split, in each of the triangles (n,), the edge that lies farthest from the surface.

    One edge a triangle and a round: those whose neighbours have been split are passed over.
    Returns the first of the new vertices, which the caller embeds.
    """
    first = t.count[0]
    for k in triangles:
        best, farthest = NIL, 0.0
        fresh = True
        for e in range(3 * k, 3 * k + 3):
            a, b = t.tri[e], t.tri[next_half_edge(e)]
            if a >= first or b >= first:
                fresh = False
            elif t.adj[e] >= 0 and t.fixed[e] == 0:
                far = abs(rise(s, a, b)) + abs(rise(s, b, a))
                if far > farthest:
                    best, farthest = e, far
        if fresh and best != NIL:
            _halve(t, s, best, active, dirty)
    return first
