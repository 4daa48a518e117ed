"""Gradation against shortest paths, accuracy of patches against numpy."""

import heapq

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.patches import NONE, patches

from surfmesh._core.fields import grade, patch_errors


def graded_by_dijkstra(patch, joined, r, slope, h):
    """h at most slope times the distance along grid edges and diagonals above any other."""
    edges = {}
    for p in patch.tolist():
        for i in range(9):
            for j in range(9):
                if i != j and abs(i % 3 - j % 3) <= 1 and abs(i // 3 - j // 3) <= 1:
                    edges.setdefault(p[i], {})[p[j]] = slope * np.linalg.norm(r[p[i]] - r[p[j]])
    for a, b in joined.tolist():
        edges[a][b] = edges[b][a] = slope * np.linalg.norm(r[a] - r[b])
    done, queue = {}, [(size, node) for node, size in enumerate(h)]
    heapq.heapify(queue)
    while queue:
        size, node = heapq.heappop(queue)
        if node not in done:
            done[node] = size
            for other, rise in edges.get(node, {}).items():
                heapq.heappush(queue, (size + rise, other))
    return np.array([done[node] for node in range(len(h))])


@settings(max_examples=25)
@given(
    st.integers(0, 10_000), st.integers(1, 5), st.integers(1, 5),
    st.sampled_from([0.01, 0.2, 2.0]), st.booleans(),
)  # fmt: skip
def test_grade(seed, nx, ny, slope, join):
    rng = np.random.default_rng(seed)
    patch = patches(nx, ny)
    r = rng.uniform(0, 1, ((2 * nx + 1) * (2 * ny + 1), 3))
    h = 10.0 ** rng.uniform(-2, 1, len(r))
    left = np.arange(2 * ny + 1) * (2 * nx + 1)
    joined = np.stack([left, left + 2 * nx], axis=1).astype(np.int32) if join else NONE
    expected = graded_by_dijkstra(patch, joined, r, slope, h)
    found = h.copy()
    changed = np.ones(len(h), np.int32)
    assert grade(patch, joined, r, slope, found, changed, 2, 400)[1]
    assert (found <= h).all() and (found >= expected * (1 - 1e-12)).all()
    np.testing.assert_allclose(found, expected, rtol=0.02)  # sweeps end at changes of 0.1%


def test_smooth_sizes_are_left_alone():
    patch = patches(4, 4)
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0))
    r = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    h = 1 + 0.1 * r[:, 0]
    found = h.copy()
    changed = np.ones(len(h), np.int32)
    assert grade(patch, NONE, r, 0.11, found, changed, 2, 400) == (4, True)
    assert (found == h).all()


def test_too_few_sweeps_are_reported():
    patch = patches(8, 8)
    rng = np.random.default_rng(1)
    r, h = rng.uniform(0, 1, (289, 3)), 10.0 ** rng.uniform(-6, 1, 289)
    assert grade(patch, NONE, r, 0.01, h, np.ones(289, np.int32), 2, 1) == (3, False)


def test_only_what_has_changed_is_looked_at():
    """A graded field with one node lowered, and the same from scratch."""
    patch = patches(6, 6)
    x, y = np.meshgrid(np.arange(13.0), np.arange(13.0))
    r = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    h = np.full(len(r), 5.0)
    h[84] = 0.5
    changed = np.zeros(len(h), np.int32)
    changed[84] = 1
    found = h.copy()
    grade(patch, NONE, r, 0.5, found, changed, 2, 400)
    np.testing.assert_allclose(found, graded_by_dijkstra(patch, NONE, r, 0.5, h), rtol=0.01)
    untouched = h.copy()
    assert grade(patch, NONE, r, 0.5, untouched, 0 * changed, 2, 400) == (4, True)
    assert (untouched == h).all()


@settings(max_examples=25)
@given(st.integers(0, 10_000))
def test_patch_errors(seed):
    rng = np.random.default_rng(seed)
    patch = patches(3, 2)
    n = 35
    m = rng.normal(size=(n, 2, 2))
    spd = m @ m.transpose(0, 2, 1) + 0.1 * np.eye(2)
    inverse = np.stack([spd[:, 0, 0], spd[:, 0, 1], spd[:, 1, 1]], axis=1)
    step, largest = rng.uniform(0.1, 1, (6, 2)), 100.0
    error, extent = patch_errors(patch, inverse, step, largest)
    for k, p in enumerate(patch):
        a = spd[p].reshape(3, 3, 2, 2)
        linear = {(j, 1): (a[j, 0] + a[j, 2]) / 2 for j in (0, 2)}
        linear |= {(1, i): (a[0, i] + a[2, i]) / 2 for i in (0, 2)}
        linear[1, 1] = (a[0, 0] + a[0, 2] + a[2, 0] + a[2, 2]) / 4
        worst = max(
            np.linalg.norm(np.linalg.solve(a[j, i] + np.eye(2) / largest, x - a[j, i]))
            for (j, i), x in linear.items()
        )
        assert error[k] == pytest.approx(worst, rel=1e-6)
        across = max(np.linalg.norm(a[j, i] @ [step[k, 0], 0]) for j in range(3) for i in range(3))
        up = max(np.linalg.norm(a[j, i] @ [0, step[k, 1]]) for j in range(3) for i in range(3))
        assert extent[k] == pytest.approx(max(across, up))
