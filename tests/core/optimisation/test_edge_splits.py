"""Splits of edges: the invariants hold after each, and nothing is lost."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.triangulation import (
    area,
    check_triangulation,
    corners,
    half_edges,
    random_plane,
    triangle_set,
)

from surfmesh._core import NIL
from surfmesh._core.optimisation import split_edge

seeds = st.integers(0, 2**31)


@settings(max_examples=20)
@given(seeds)
def test_splitting_edges(seed):
    t = random_plane(seed, 20)
    whole, rng = area(t), np.random.default_rng(seed)
    for _ in range(15):
        inner = [
            (a, b)
            for (a, b), e in sorted(half_edges(t).items())
            if NIL not in corners(t)[e // 3] and NIL not in corners(t)[t.adj[e] // 3]
        ]
        a, b = inner[rng.integers(len(inner))]
        e = half_edges(t)[a, b]
        x, y = 0.5 * (t.xy[a] + t.xy[b])
        p = split_edge(t, e, x, y)
        assert p == t.vertices - 1
        assert {(a, p), (p, b), (b, p), (p, a)} <= half_edges(t).keys()
        assert check_triangulation(t) is None
    assert area(t) == whole


def test_a_split_beyond_the_quadrilateral_changes_nothing():
    t = random_plane(8)
    before = triangle_set(t)
    e = next(
        e for e in half_edges(t).values()
        if NIL not in corners(t)[e // 3] and NIL not in corners(t)[t.adj[e] // 3]
    )  # fmt: skip
    assert split_edge(t, e, 9.0, 9.0) == NIL
    assert split_edge(t, e, *t.xy[t.tri[e]]) == NIL
    assert triangle_set(t) == before and check_triangulation(t) is None


def test_what_is_no_inner_edge_is_refused():
    t = random_plane(8)
    ghost = next(e for e in half_edges(t).values() if NIL in corners(t)[e // 3])
    for e in (-1, 3 * t.triangles, ghost):
        with pytest.raises(ValueError):
            split_edge(t, e, 0.5, 0.5)
