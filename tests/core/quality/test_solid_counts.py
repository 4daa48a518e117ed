"""Vertices and edges of solids, against sets of them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfmesh._core.quality import solid_counts


def slow(triangles, solid, solids):
    counts = []
    for k in range(solids):
        own = triangles[solid == k].tolist()
        balance = {}
        for a, b in ((t[i], t[(i + 1) % 3]) for t in own for i in range(3)):
            key = min(a, b), max(a, b)
            balance[key] = balance.get(key, 0) + (1 if a < b else -1)
        used = {corner for t in own for corner in t}
        counts.append((len(used), len(balance), sum(value != 0 for value in balance.values())))
    return np.array(counts).T


@given(st.integers(0, 2**31))
def test_counts_are_those_of_sets(seed):
    draw = np.random.default_rng(seed)
    triangles = draw.integers(0, 6, size=(20, 3)).astype(np.int32)
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    solid = draw.integers(0, 3, len(triangles)).astype(np.int32)
    assert (np.array(solid_counts(triangles, solid, 6, 3)) == slow(triangles, solid, 3)).all()


def test_what_is_out_of_range_is_refused():
    one = np.array([[0, 1, 2]], np.int32)
    for triangles, solid in ((one, [1]), (one + 1, [0]), (one, [0, 0]), (one, [-1])):
        with pytest.raises(ValueError):
            solid_counts(triangles, np.array(solid, np.int32), 3, 1)
