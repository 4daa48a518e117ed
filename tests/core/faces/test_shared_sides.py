"""Sides between vertices that faces share."""

from collections import Counter

import numpy as np
import pytest

from surfmesh._core.faces import has_crowded_side, triangles_of_shared


def slow(triangles, shared):
    sides = Counter()
    for a, b, c in triangles.tolist():
        sides.update(tuple(sorted(s)) for s in ((a, b), (b, c), (c, a)) if shared[list(s)].all())
    return any(count > 2 for count in sides.values())


def test_crowded_sides_are_those_of_the_slow_twin():
    rng = np.random.default_rng(5)
    seen = Counter()
    for _ in range(200):
        triangles = np.array([rng.permutation(14)[:3] for _ in range(20)], np.int32)
        shared = rng.random(14) < 0.6
        found = has_crowded_side(triangles, shared.view(np.uint8))
        assert found == slow(triangles, shared)
        seen[found] += 1
        rows = triangles_of_shared(triangles, shared.view(np.uint8))
        assert (rows == np.flatnonzero(shared[triangles].all(axis=1))).all()
    assert min(seen.values()) > 20 and len(seen) == 2


def test_what_does_not_fit_is_refused():
    one = np.array([[0, 1, 2]], np.int32)
    for work in (has_crowded_side, triangles_of_shared):
        with pytest.raises(ValueError, match="out of range"):
            work(one, np.ones(2, np.uint8))
        assert not np.any(work(np.empty((0, 3), np.int32), np.ones(2, np.uint8)))
