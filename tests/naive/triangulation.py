"""Invariants of triangulations and of the front, each the first that is broken, in words."""

from collections import Counter
from fractions import Fraction

import numpy as np
from scipy.spatial import Delaunay

from naive.exact import first_crossing, orient_signs, triangles_area
from surfmesh._core import NIL
from surfmesh._core import triangulation as core
from surfmesh._core.triangulation import DEAD, DONE


def live_triangles(t: core.Triangulation) -> np.ndarray:
    """Numbers of the slots in use."""
    m = t.triangles
    return np.flatnonzero(t.region[:m] != DEAD)


def corners(t: core.Triangulation) -> np.ndarray:
    """(m, 3) vertices of all slots, dead ones too."""
    return t.tri[: 3 * t.triangles].reshape(-1, 3)


def check_half_edges(t: core.Triangulation, border: bool) -> str | None:
    """Twins point back and run the other way; real triangles are counter-clockwise, exactly.

    ``border``: half-edges without twin are allowed, ghosts are not.
    """
    n, m = t.vertices, t.triangles
    live = live_triangles(t)
    tri = corners(t)
    for k in live:
        if len(set(tri[k].tolist())) != 3:
            return f"triangle {k} = {tri[k].tolist()} repeats a corner"
        if tri[k].min() < (0 if border else NIL) or tri[k].max() >= n:
            return f"triangle {k} = {tri[k].tolist()} has a corner outside 0..{n - 1}"
    half = (3 * live[:, None] + np.arange(3)).ravel()
    start, end = t.tri[half], t.tri[half - half % 3 + (half + 1) % 3]
    pairs = Counter(zip(start.tolist(), end.tolist()))
    twice = next((pair for pair, number in pairs.items() if number > 1), None)
    if twice:
        return f"edge {twice} runs the same way in two triangles"
    for e, a, b in zip(half.tolist(), start.tolist(), end.tolist()):
        f = int(t.adj[e])
        if f == NIL and border:
            if (b, a) in pairs:
                return f"half-edge {e} = {a} -> {b} has no twin, but {b} -> {a} exists"
            continue
        if not 0 <= f < 3 * m or t.region[f // 3] == DEAD:
            return f"half-edge {e} has twin {f}, which is no live half-edge"
        if t.adj[f] != e:
            return f"half-edge {e} has twin {f}, whose twin is {t.adj[f]}"
        if (t.tri[f], t.tri[f - f % 3 + (f + 1) % 3]) != (b, a):
            return f"half-edge {e} = {a} -> {b} has twin {f}, which is not {b} -> {a}"
        if len(t.fixed) and t.fixed[e] != t.fixed[f]:
            return f"half-edge {e} and its twin {f} disagree about being fixed"
    real = live[(tri[live] >= 0).all(axis=1)]
    signs = orient_signs(*(t.xy[tri[real, i]] for i in range(3)))
    if (signs <= 0).any():
        k = real[np.argmax(signs <= 0)]
        return f"triangle {k} = {tri[k].tolist()} is not counter-clockwise"
    return None


def check_triangulation(t: core.Triangulation, removed: int = 0) -> str | None:
    """Invariants of a triangulation of the whole plane; ``removed`` vertices are unused."""
    broken = check_half_edges(t, border=False)
    if broken:
        return broken
    n = t.vertices - removed
    live = live_triangles(t)
    tri = corners(t)[live]
    if len(live) != 2 * n - 2:
        return f"{len(live)} triangles on {n} vertices, Euler's number wants {2 * n - 2}"
    used = np.unique(tri)
    if len(used) != n + 1:  # NIL is one of them
        return f"{len(used) - 1} vertices are used, not {n}"
    after = {}
    for row in tri[(tri < 0).any(axis=1)].tolist():
        i = row.index(NIL)
        after[row[(i + 2) % 3]] = row[(i + 1) % 3]  # ghost (b, a, NIL) of the hull edge a -> b
    hull = _one_loop(after)
    if isinstance(hull, str):
        return "the hull " + hull
    xy = t.xy[hull]
    signs = orient_signs(xy, np.roll(xy, -1, axis=0), np.roll(xy, -2, axis=0))
    if (signs < 0).any():
        return f"the hull is not convex at vertex {hull[(int(np.argmin(signs)) + 1) % len(hull)]}"
    return None


def _one_loop(after: dict[int, int]) -> list[int] | str:
    start = min(after)
    loop, v = [start], after[start]
    while v != start:
        if v not in after or len(loop) > len(after):
            return f"is open at vertex {v}"
        loop.append(v)
        v = after[v]
    return loop if len(loop) == len(after) else f"has {len(after)} edges, one loop {len(loop)}"


def front_loop(packing) -> list[int]:
    """The vertices of the front in order."""
    following = packing.front[:, 0]
    start = int(np.flatnonzero(following != NIL)[0])
    loop, v = [start], int(following[start])
    while v != start and len(loop) <= len(following):
        loop.append(v)
        v = int(following[v])
    return loop


def check_front(packing, simple_up_to: int = 600) -> str | None:
    """The front is the border of DONE, one simple polygon, and DONE is a disc.

    The crossing test of all pairs is left out for fronts longer than ``simple_up_to``.
    """
    t = packing.t
    following, before, edge = packing.front.T
    n, m = t.vertices, t.triangles
    region, tri = t.region, corners(t)
    if (tri[region == DONE] < 0).any():
        return "a ghost is done"
    half = np.arange(3 * m)
    border = half[(region[half // 3] == DONE) & (region[t.adj[half] // 3] != DONE)]
    after = {}
    for e in border.tolist():
        a, b = int(t.tri[e]), int(t.tri[e - e % 3 + (e + 1) % 3])
        if a in after:
            return f"the border of what is done passes vertex {a} twice"
        after[a] = b
        if following[a] != b or before[b] != a or edge[a] != e:
            return (
                f"border {a} -> {b} is half-edge {e}, the front has next {following[a]}, "
                f"prev {before[b]}, edge {edge[a]}"
            )
    linked = np.flatnonzero(following != NIL)
    if set(linked.tolist()) != set(after) or (linked >= n).any():
        return "the front has vertices that are not on the border of what is done"
    if set(np.flatnonzero(before != NIL).tolist()) != set(after):
        return "next and prev of the front disagree"
    loop = _one_loop(after)
    if isinstance(loop, str):
        return "the front " + loop
    if len(loop) <= simple_up_to:
        crossing = first_crossing(t.xy[loop])
        if crossing:
            return f"edges {crossing} of the front {loop} meet"
    done = tri[region == DONE]
    edges = {tuple(sorted(pair)) for row in done.tolist() for pair in zip(row, row[1:] + row[:1])}
    euler = len(np.unique(done)) - len(edges) + len(done)
    if euler != 1:
        return f"what is done has V - E + F = {euler}, a disc has 1"
    if len(np.unique(done)) != n:
        return f"{n - len(np.unique(done))} vertices belong to no done triangle"
    return None


def check_domain(t: core.Triangulation, euler: int) -> str | None:
    """Invariants of a triangulated domain, whose border half-edges have no twin."""
    broken = check_half_edges(t, border=True)
    if broken:
        return broken
    tri = corners(t)[live_triangles(t)]
    edges = {tuple(sorted(pair)) for row in tri.tolist() for pair in zip(row, row[1:] + row[:1])}
    found = len(np.unique(tri)) - len(edges) + len(tri)
    return None if found == euler else f"V - E + F = {found}, expected {euler}"


def plane_triangulation(xy: np.ndarray, size: np.ndarray | None = None) -> core.Triangulation:
    """Delaunay's triangulation of points (n, 2) with ghosts, ready for fixed edges.

    Its sizes are the unit circle's unless given (n, 3). All triangles have region 0.
    """
    xy = np.asarray(xy, float)
    rows = []
    for a, b, c in Delaunay(xy).simplices.tolist():
        s = orient_signs(*(xy[[v]] for v in (a, b, c)))[0]
        rows.append((a, b, c) if s > 0 else (a, c, b))
    edges = {(p, q) for row in rows for p, q in zip(row, row[1:] + row[:1])}
    rows += [(b, a, NIL) for a, b in sorted(edges) if (b, a) not in edges]
    where = {}
    for k, row in enumerate(rows):
        for i in range(3):
            where[row[i], row[(i + 1) % 3]] = 3 * k + i
    adj = np.empty(3 * len(rows), np.int32)
    for (a, b), e in where.items():
        adj[e] = where[b, a]
    if size is None:
        size = np.tile([1.0, 0.0, 1.0], (len(xy), 1))
    tri = np.array(rows, np.int32).ravel()
    nothing = np.zeros(len(rows), np.uint8)
    return core.Triangulation(xy, size, tri, adj, nothing, np.repeat(nothing, 3))


def random_plane(seed: int, n: int = 30) -> core.Triangulation:
    """The plane triangulated over n random points of the unit square."""
    return plane_triangulation(np.random.default_rng(seed).uniform(0, 1, (n, 2)))


def area(t: core.Triangulation) -> Fraction:
    """Of the live triangles without the ghosts, exactly."""
    rows = corners(t)[live_triangles(t)]
    return triangles_area(t.xy, rows[(rows >= 0).all(axis=1)].tolist())


def half_edges(t: core.Triangulation) -> dict[tuple[int, int], int]:
    """(start, end) -> half-edge, for all live triangles."""
    return {
        (int(t.tri[3 * k + i]), int(t.tri[3 * k + (i + 1) % 3])): int(3 * k + i)
        for k in live_triangles(t)
        for i in range(3)
    }


def triangle_set(t: core.Triangulation) -> set[tuple[int, int, int]]:
    """The live triangles, each turned so that its smallest vertex comes first."""
    turned = set()
    for row in corners(t)[live_triangles(t)].tolist():
        i = row.index(min(row))
        turned.add((row[i], row[(i + 1) % 3], row[(i + 2) % 3]))
    return turned
