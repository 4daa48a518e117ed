"""Look-up in the background against a walk by recursion and eigenvalues by numpy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.background import capped_inverse, looked_up, random_tree, uniform_background
from naive.metric import matrix

from surfmesh.kernels.fields.background import (
    invert,
    metric_root_at,
    metric_roots_at,
    scalar_sizes_at,
    sizes_at,
)


def places(seed, n):
    """Points in the unit square, on its cell borders, and some outside."""
    rng = np.random.default_rng(seed)
    return np.concatenate(
        [
            rng.uniform(0, 1, (n, 2)),
            rng.uniform(-0.5, 1.5, (n, 2)),
            rng.integers(0, 9, (n, 2)) / 8.0,
            [[0, 0], [1, 1], [1, 0], [0, 1]],
        ]
    )


@settings(max_examples=20)
@given(st.integers(0, 1000), st.sampled_from([(1, 1), (4, 1), (2, 2)]), st.integers(0, 30))
def test_walk_down_the_tree(seed, cells, splits):
    tree = random_tree(seed, *cells, splits)
    xy = places(seed, 20)
    found, scalar = np.empty((len(xy), 3)), np.empty(len(xy))
    metric_roots_at(tree, xy, found)
    scalar_sizes_at(tree, xy, scalar)
    expected = np.array([looked_up(tree, x, y) for x, y in xy])
    np.testing.assert_allclose(found, expected[:, :3], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(scalar, 1.0 / expected[:, 3], rtol=1e-9)


@settings(max_examples=20)
@given(st.integers(0, 1000), st.sampled_from([1e30, 3.0, 0.3]))
def test_size_tensors_are_capped(seed, largest):
    tree = random_tree(seed, 2, 2, 5, largest)
    xy = places(seed, 10)
    found = np.empty((len(xy), 3))
    sizes_at(tree, xy, found)
    for point, h in zip(xy, found):
        expected = capped_inverse(matrix(looked_up(tree, *point)), largest)
        np.testing.assert_allclose(matrix(h), expected, rtol=1e-7, atol=1e-9 * expected.max())
        assert np.linalg.eigvalsh(matrix(h)).max() <= largest * (1 + 1e-9)


@given(
    st.floats(0, np.pi),
    st.sampled_from([0.0, 1e-12, 1e-3, 0.999, 1.0, 1.001, 5.0, 1e6]),
    st.sampled_from([0.0, 1e-12, 1e-3, 0.999, 1.0, 1.001, 5.0, 1e6]),
)
def test_eigenvalues_on_both_sides_of_the_cap(angle, p, q):
    c, s = np.cos(angle), np.sin(angle)
    a = matrix([p * c * c + q * s * s, (p - q) * c * s, p * s * s + q * c * c])
    h = matrix(invert(a[0, 0], a[0, 1], a[1, 1], 1.0))
    assert np.isfinite(h).all()
    np.testing.assert_allclose(h, capped_inverse(a, 1.0), rtol=1e-6, atol=1e-6)
    assert np.linalg.eigvalsh(h).min() > 0


def test_bilinear_functions_are_met_exactly():
    x, y = np.meshgrid(np.linspace(0, 3, 4), np.linspace(0, 2, 5))
    a = np.stack([2 + x + y + x * y, 0.1 * x, 5 + y - 0.5 * x], axis=-1)
    field = uniform_background(a, 3.0, 2.0)
    for px, py in np.random.default_rng(1).uniform(0, 2, (20, 2)):
        expected = (2 + px + py + px * py, 0.1 * px, 5 + py - 0.5 * px)
        assert metric_root_at(field, px, py) == pytest.approx(expected)


def test_outside_the_box_the_nearest_point_counts():
    x, y = np.meshgrid(np.linspace(0, 1, 3), np.linspace(0, 1, 3))
    field = uniform_background(np.stack([1 + x, 0 * x, 1 + y], axis=-1), 1.0, 1.0)
    assert metric_root_at(field, -7.0, 0.25) == pytest.approx((1.0, 0.0, 1.25))
    assert metric_root_at(field, 1e300, -1e300) == pytest.approx((2.0, 0.0, 1.0))
