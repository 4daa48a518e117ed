"""Swap, remove: the invariants hold after each, and nothing is lost."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.triangulation import (
    area,
    check_triangulation,
    corners,
    half_edges,
    plane_triangulation,
    random_plane,
    triangle_set,
)

from surfmesh._core import NIL


def following(e):
    return e - 2 if e % 3 == 2 else e + 1


seeds = st.integers(0, 2**31)


@settings(max_examples=20)
@given(seeds)
def test_random_swaps(seed):
    t = random_plane(seed)
    rng, whole = np.random.default_rng(seed), area(t)
    assert check_triangulation(t) is None
    for e in rng.integers(0, 3 * t.triangles, 60).tolist():
        if t.is_convex(e):
            a, b = t.tri[e], t.tri[t.adj[e]]
            t.swap_edge(e)
            assert (a, b) not in half_edges(t)
    assert check_triangulation(t) is None
    assert area(t) == whole


@settings(max_examples=20)
@given(seeds)
def test_swapping_back(seed):
    """A swap turns the edge by a quarter: two give the same edge, twelve the same slots."""
    t = random_plane(seed, 12)
    before, tri, adj = triangle_set(t), t.tri.copy(), t.adj.copy()
    e = next(e for e in range(3 * t.triangles) if t.is_convex(e))
    for k in range(1, 13):
        assert t.is_convex(e)
        t.swap_edge(e)
        e = following(e)  # the new edge
        assert check_triangulation(t) is None
        assert (triangle_set(t) == before) == (k % 2 == 0)
    m = 3 * t.triangles
    assert (t.tri[:m] == tri[:m]).all() and (t.adj[:m] == adj[:m]).all()


def test_convex_is_strict():
    """A diagonal of a square may be swapped, not one whose end lies on the other diagonal."""
    square = plane_triangulation([(0, 0), (1, 0), (1.1, 1), (0, 1)])
    e = next(e for (a, b), e in half_edges(square).items() if {a, b} in ({0, 2}, {1, 3}))
    assert square.is_convex(e)
    kite = plane_triangulation([(0, 0), (2, 0), (1, 1), (1, -1e-3)])
    for corner in ((1.0, 0.0), (1.0, 1e-3)):  # on the line between 0 and 1, or past it
        kite.xy[3] = corner
        e = half_edges(kite).get((2, 3))
        if e is not None:
            assert not kite.is_convex(e)


def test_hull_edges_are_never_swapped():
    t = random_plane(3)
    for (a, b), e in half_edges(t).items():
        if (b, NIL) in half_edges(t) and (a, NIL) in half_edges(t):
            on_hull = NIL in corners(t)[e // 3] or NIL in corners(t)[t.adj[e] // 3]
            assert not (on_hull and t.is_convex(e))


@settings(max_examples=20)
@given(seeds, st.booleans())
def test_removing_vertices(seed, on_a_grid):
    """Until nothing is left inside the hull; a grid has many collinear stars."""
    rng = np.random.default_rng(seed)
    if on_a_grid:
        x, y = np.meshgrid(np.arange(6.0), np.arange(5.0))
        t = plane_triangulation(np.stack([x.ravel(), y.ravel()], axis=1))
    else:
        t = random_plane(seed)
    whole, removed = area(t), 0
    hull = {a for a, b in half_edges(t) if b == NIL}
    for v in rng.permutation(t.vertices).tolist():
        e = next(e for (a, _), e in half_edges(t).items() if a == v)
        left = t.remove_vertex(e)
        if v in hull:
            assert left == NIL
        else:
            assert left != NIL
            removed += 1
            assert left in half_edges(t).values()
        assert check_triangulation(t, removed) is None
    assert area(t) == whole
    assert removed == t.vertices - len(hull)


def test_a_vertex_on_a_fixed_edge_stays():
    t = random_plane(5)
    hull = {a for a, b in half_edges(t) if b == NIL}
    a, b = next(edge for edge in half_edges(t) if not hull & set(edge))
    e = half_edges(t)[a, b]
    t.fixed[e] = t.fixed[t.adj[e]] = 1
    before = triangle_set(t)
    for v in (a, b):
        for f in [f for (p, _), f in half_edges(t).items() if p == v]:
            assert t.remove_vertex(f) == NIL
    assert triangle_set(t) == before
    assert check_triangulation(t) is None


def test_removal_keeps_fixed_edges_of_the_rim():
    t = random_plane(6)
    hull = {a for a, b in half_edges(t) if b == NIL}
    v = next(v for v in range(30) if v not in hull)
    star = [e for (p, _), e in half_edges(t).items() if p == v]
    rim = [following(e) for e in star]
    ends = set()
    for e in rim:
        t.fixed[e] = t.fixed[t.adj[e]] = 1
        ends.add((int(t.tri[e]), int(t.tri[following(e)])))
    assert t.remove_vertex(star[0]) != NIL
    now = half_edges(t)
    assert check_triangulation(t, 1) is None
    assert {edge for edge, e in now.items() if t.fixed[e]} == ends | {(b, a) for a, b in ends}


def test_turn_goes_round_counter_clockwise():
    t = random_plane(7)
    hull = {a for a, b in half_edges(t) if b == NIL}
    v = next(v for v in range(30) if v not in hull)
    first = next(e for (p, _), e in half_edges(t).items() if p == v)
    angles, e = [], first
    while True:
        x, y = t.xy[t.tri[following(e)]] - t.xy[v]
        angles.append(np.arctan2(y, x))
        e = int(t.adj[e - 1 if e % 3 else e + 2])
        if e == first:
            break
    steps = np.diff([*angles, angles[0]]) % (2 * np.pi)
    assert len(angles) == sum(p == v for p, _ in half_edges(t))
    assert steps.sum() == pytest.approx(2 * np.pi) and (steps < np.pi).all()
