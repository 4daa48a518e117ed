"""Gradation against the formula of Hopf and Lax by samples, accuracy of patches against numpy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.gradation import graded_by_dijkstra, graded_by_samples
from naive.patches import NONE, patches

from surfmesh._core.fields import grade, patch_errors


@settings(max_examples=25)
@given(
    st.integers(0, 10_000), st.integers(1, 3), st.integers(1, 3),
    st.sampled_from([0.01, 0.2, 2.0]), st.booleans(),
)  # fmt: skip
def test_grade(seed, nx, ny, slope, join):
    rng = np.random.default_rng(seed)
    patch = patches(nx, ny)
    r = rng.uniform(0, 1, ((2 * nx + 1) * (2 * ny + 1), 3))
    h = 10.0 ** rng.uniform(-2, 1, len(r))
    left = np.arange(2 * ny + 1) * (2 * nx + 1)
    joined = np.stack([left, left + 2 * nx], axis=1).astype(np.int32) if join else NONE
    expected = graded_by_samples(patch, joined, r, slope, h)
    found = h.copy()
    changed = np.ones(len(h), np.int32)
    assert grade(patch, joined, r, slope, found, changed, 1, 10_000)[1]
    assert (found <= h).all() and (found >= expected * (1 - 1e-6)).all()
    np.testing.assert_allclose(found, expected, rtol=0.02)


def test_smooth_sizes_are_left_alone():
    patch = patches(4, 4)
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0))
    r = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    h = 1 + 0.1 * r[:, 0]
    found = h.copy()
    changed = np.ones(len(h), np.int32)
    assert grade(patch, NONE, r, 0.11, found, changed, 1, 10_000) == (0, True)
    assert (found == h).all()


def test_too_few_visits_are_reported():
    patch = patches(8, 8)
    rng = np.random.default_rng(1)
    r, h = rng.uniform(0, 1, (289, 3)), 10.0 ** rng.uniform(-6, 1, 289)
    assert grade(patch, NONE, r, 0.01, h, np.ones(289, np.int32), 1, 50) == (50, False)


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
    grade(patch, NONE, r, 0.5, found, changed, 1, 10_000)
    np.testing.assert_allclose(found, graded_by_samples(patch, NONE, r, 0.5, h), rtol=0.01)
    untouched = h.copy()
    assert grade(patch, NONE, r, 0.5, untouched, 0 * changed, 1, 10_000) == (0, True)
    assert (untouched == h).all()


@pytest.mark.parametrize("shear", [0.0, 1.0, -2.5])
@pytest.mark.parametrize("stretch", [1.0, 4.0])
def test_distances_are_those_of_the_surface_not_of_the_grid(shear, stretch):
    """From one small size in a sheared plane: paths along edges are up to 3.5 times as long."""
    n, slope = 16, 0.2
    patch = patches(n, n)
    i, j = np.meshgrid(np.arange(2 * n + 1) - n, np.arange(2 * n + 1) - n)
    r = np.stack([i + shear * j, stretch * j, 0 * i], axis=-1).reshape(-1, 3).astype(float)
    h = np.full(len(r), 1e3)
    middle = (2 * n + 1) * n + n
    h[middle] = 0.5
    by_edges = graded_by_dijkstra(patch, NONE, r, slope, h)
    grade(patch, NONE, r, slope, h, np.ones(len(h), np.int32), 1, 10_000)
    distance = slope * np.linalg.norm(r - r[middle], axis=1)
    far = np.flatnonzero((np.abs(i) > 6).ravel() | (np.abs(j) > 6).ravel())
    excess, of_edges = ((sizes[far] - 0.5) / distance[far] - 1 for sizes in (h, by_edges))
    assert excess.min() > -1e-9
    assert excess.max() < 0.4 * of_edges.max() and np.median(excess) < 0.02


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
