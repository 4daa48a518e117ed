"""Gradation of anisotropic sizes against what it promises, written with 3 x 3 matrices."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.gradation import graded_by_dijkstra
from naive.metric import tangent_metric, turned
from naive.patches import NONE, patches

from surfmesh._core.fields import TURN_SLOPE, grade_stretched


def neighbours(patch):
    pairs = set()
    for p in patch.tolist():
        for i in range(9):
            for j in range(9):
                if i != j and abs(i % 3 - j % 3) <= 1 and abs(i // 3 - j // 3) <= 1:
                    pairs.add((p[i], p[j]))
    return pairs


def stretched(patch, joined, r, slope, h, long, along, normal, changed, visits=10_000):
    """Grade in place; says whether the visits sufficed."""
    round = np.empty(0, np.uint8)
    return grade_stretched(
        patch, joined, r, slope, h, long, along, normal, round, changed, 1, visits
    )[1]


def random_field(rng, n, ratio, turn):
    """Nodes on a bent sheet: h, long, along, normal, points of a grid of (n, n)."""
    x, y = np.meshgrid(np.arange(float(n)), np.arange(float(n)))
    x, y = x.ravel(), y.ravel()
    r = np.stack([x, y, 0.1 * x * x], axis=1)
    normal = np.stack([-0.2 * x, 0 * x, 0 * x + 1], axis=1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    first = np.cross(normal, [0.0, 1.0, 0.0])
    first /= np.linalg.norm(first, axis=1)[:, None]
    angle = turn * rng.uniform(-1, 1, len(x))
    across = np.cross(normal, first)
    along = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * across
    h = 10.0 ** rng.uniform(-1, 0.5, len(x))
    return h, h * ratio ** rng.uniform(0, 1, len(x)), along, normal, r


@settings(max_examples=20, deadline=None)
@given(
    st.integers(0, 10_000), st.sampled_from([0.05, 0.2, 1.0]), st.sampled_from([1.0, 5.0, 200.0]),
    st.sampled_from([0.0, 0.05, 3.0]),
)  # fmt: skip
def test_every_metric_contains_its_neighbours_grown(seed, slope, ratio, turn):
    rng = np.random.default_rng(seed)
    patch = patches(2, 2)
    h0, long0, along, normal, r = random_field(rng, 5, ratio, turn)
    h, long, t = h0.copy(), long0.copy(), along.copy()
    changed = np.ones(len(h), np.int32)
    assert stretched(patch, NONE, r, slope, h, long, t, normal, changed, 100_000)
    assert (h <= h0).all() and (long <= long0).all()
    np.testing.assert_array_equal(t, along)  # directions are the surface's, not changed
    for a, b in neighbours(patch):
        carried = turned(along[a], normal[a], normal[b])
        step = r[b] - r[a]
        onward = step @ along[a]
        distance = np.hypot(onward / long[a], np.sqrt(max(step @ step - onward**2, 0)) / h[a])
        of_a = tangent_metric(h[a], long[a], carried, normal[b])
        of_b = tangent_metric(h[b], long[b], along[b], normal[b])
        across = np.cross(normal[b], along[b])
        growth = 1.0 + slope * distance
        for size, direction in ((h[b], across), (long[b], along[b])):
            assert size <= 1.002 * growth / np.sqrt(direction @ of_a @ direction)
        chord = np.sqrt(step @ step)
        ways = [step - (step @ n) * n for n in (normal[a], normal[b])]
        at_a, at_b = (
            np.sqrt(way @ way / (way @ metric @ way))
            for way, metric in zip(ways, (tangent_metric(h[a], long[a], along[a], normal[a]), of_b))
        )
        is_least = min(h[b], long[b]) <= 1.002 * growth * min(h[a], long[a])
        assert at_b <= 1.012 * (at_a + slope * chord) or is_least
        faster = 1.0 + TURN_SLOPE * slope * distance
        basis = np.stack([along[b], across], axis=1)
        excess = np.linalg.eigvalsh(basis.T @ (of_b * 1.005 - of_a / faster**2) @ basis)
        assert excess.min() > -1e-9 * np.abs(of_b).max()


def test_round_metrics_are_graded_as_sizes_are_along_edges():
    rng = np.random.default_rng(3)
    patch = patches(2, 2)
    h0, _, along, normal, r = random_field(rng, 5, 1.0, 3.0)
    h, long = h0.copy(), h0.copy()
    sizes = graded_by_dijkstra(patch, NONE, r, 0.2, h0)
    stretched(patch, NONE, r, 0.2, h, long, along, normal, np.ones(len(h), np.int32))
    np.testing.assert_allclose(h, sizes, rtol=2e-3)
    np.testing.assert_allclose(long, sizes, rtol=2e-3)


def test_nodes_without_a_normal_stay_round():
    patch = patches(1, 1)
    h0, long0, along, normal, r = random_field(np.random.default_rng(1), 3, 50.0, 0.0)
    normal[4] = 0.0
    h0[4] = long0[4] = 1e3
    h, long = h0.copy(), long0.copy()
    stretched(patch, NONE, r, 0.2, h, long, along, normal, np.ones(9, np.int32))
    assert h[4] == long[4] < 1e3


def test_a_joint_of_opposite_normals_does_not_matter():
    """Across the joined sides of a Moebius strip the normal is turned over."""
    patch = np.arange(18, dtype=np.int32).reshape(2, 9)
    h0, long0, along, normal, r = random_field(np.random.default_rng(1), 3, 20.0, 0.1)
    both = [np.concatenate([a, b]) for a, b in (
        (h0, 3 * h0), (long0, 3 * long0), (along, along), (normal, -normal), (r, r),
    )]  # fmt: skip
    joined = np.stack([np.arange(9), np.arange(9, 18)], axis=1).astype(np.int32)
    h, long, t, n, points = both
    stretched(patch, joined, points, 0.2, h, long, t, n, np.ones(18, np.int32))
    np.testing.assert_allclose(h[:9], h[9:], rtol=2e-3)
    np.testing.assert_allclose(long[:9], long[9:], rtol=2e-3)


@pytest.mark.parametrize("bend", [0.02, 0.1])
def test_directions_that_turn_shorten_the_longer_size(bend):
    """Along a circle of curvature ``bend`` long edges would leave it: L^2 <= about 2 f h / bend."""
    n, slope, h0 = 40, 0.2, 0.05
    patch = patches(n, 1)
    angle = bend * np.linspace(0, 20, 2 * n + 1)
    rows = [
        np.stack([np.sin(angle) * (1 / bend + w), np.cos(angle) * (1 / bend + w), 0 * angle], 1)
        for w in (-0.05, 0.0, 0.05)
    ]
    r = np.concatenate(rows)
    along = np.concatenate([np.stack([np.cos(angle), -np.sin(angle), 0 * angle], 1)] * 3)
    normal = np.tile([0.0, 0.0, 1.0], (len(r), 1))
    h, long = np.full(len(r), h0), np.full(len(r), 1e3)
    changed = np.ones(len(r), np.int32)
    assert stretched(patch, NONE, r, slope, h, long, along, normal, changed, 100_000)
    assert (h == h0).all()
    expected = np.sqrt(2 * TURN_SLOPE * slope * h0 / bend)
    inner = long[len(angle) + 10 : 2 * len(angle) - 10]
    assert (0.4 * expected < inner).all() and (inner < 1.6 * expected).all()
