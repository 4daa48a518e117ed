"""Look-up in the background against a walk by recursion and eigenvalues by numpy."""

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.background import (
    capped_inverse,
    looked_up,
    random_tree,
    replaced,
    uniform_background,
)
from naive.metric import matrix

from surfmesh._core.fields import Background, invert


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
    found, scalar = tree.metric_roots(xy), tree.scalar_sizes(xy)
    expected = np.array([looked_up(tree, x, y) for x, y in xy])
    np.testing.assert_allclose(found, expected[:, :3], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(scalar, 1.0 / expected[:, 3], rtol=1e-9)


@settings(max_examples=20)
@given(st.integers(0, 1000), st.sampled_from([1e30, 3.0, 0.3]))
def test_size_tensors_are_capped(seed, largest):
    tree = random_tree(seed, 2, 2, 5, largest)
    xy = places(seed, 10)
    for point, h in zip(xy, tree.sizes(xy)):
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
    xy = np.random.default_rng(1).uniform(0, 2, (20, 2))
    for (px, py), found in zip(xy, field.metric_roots(xy)):
        expected = (2 + px + py + px * py, 0.1 * px, 5 + py - 0.5 * px)
        assert tuple(found) == pytest.approx(expected)


def test_outside_the_box_the_nearest_point_counts():
    x, y = np.meshgrid(np.linspace(0, 1, 3), np.linspace(0, 1, 3))
    field = uniform_background(np.stack([1 + x, 0 * x, 1 + y], axis=-1), 1.0, 1.0)
    first, second = field.metric_roots(np.array([[-7.0, 0.25], [1e300, -1e300]]))
    assert tuple(first) == pytest.approx((1.0, 0.0, 1.25))
    assert tuple(second) == pytest.approx((2.0, 0.0, 1.0))


def test_what_is_not_a_number_counts_as_zero():
    x, y = np.meshgrid(np.linspace(0, 1, 3), np.linspace(0, 1, 3))
    field = uniform_background(np.stack([1 + x, 0 * x, 1 + y], axis=-1), 1.0, 1.0)
    odd = np.array([[np.nan, 0.5], [np.nan, np.nan], [np.inf, -np.inf]])
    plain = np.array([[0.0, 0.5], [0.0, 0.0], [1.0, 0.0]])
    np.testing.assert_array_equal(field.sizes(odd), field.sizes(plain))


def test_metric_roots_in_space_are_interpolated_too():
    tree = random_tree(3, 2, 1, 4)
    w = np.random.default_rng(3).normal(size=(len(tree.metric_root), 6))
    both = replaced(tree, metric_root_3d=w)
    assert both.is_anisotropic and not tree.is_anisotropic
    xy = places(3, 20)
    for column in range(6):  # each as if it were 1 / h
        one = np.concatenate([tree.metric_root[:, :3], w[:, column : column + 1]], axis=1)
        expected = 1.0 / replaced(tree, metric_root=one).scalar_sizes(xy)
        np.testing.assert_allclose(both.metric_roots_3d(xy)[:, column], expected, rtol=1e-9)
    plain = tree.metric_roots_3d(xy)
    np.testing.assert_allclose(plain[:, [0, 3, 5]].T, [1.0 / tree.scalar_sizes(xy)] * 3)
    assert (plain[:, [1, 2, 4]] == 0.0).all()


@pytest.mark.parametrize(
    "wrong, message",
    [
        (dict(box=np.array([0.0, 0.0, np.nan, 1.0, 1.0])), "box"),
        (dict(box=np.ones(4)), "box"),
        (dict(grid=np.array([-1, 1])), "grid"),
        (dict(grid=np.array([1 << 40, 1 << 40])), "grid"),
        (dict(grid=np.array([6, 1])), "grid"),
        (dict(child=np.array([0, -1, -1, -1, -1], np.int32)), "cell 0 has children"),
        (dict(child=np.array([2, -1, -1, -1, -1], np.int32)), "cell 0 has children"),
        (dict(corner=np.full((5, 4), 20, np.int32)), "cell 1 has a corner"),
        (dict(corner=np.full((5, 4), -1, np.int32)), "cell 1 has a corner"),
        (dict(corner=np.zeros((4, 4), np.int32)), "corner"),
        (dict(metric_root_3d=np.zeros((3, 6))), "metric_root_3d"),
    ],
)
def test_what_cannot_be_walked_through_is_refused(wrong, message):
    arrays = dict(
        box=np.array([0.0, 0.0, 1.0, 1.0, 9.0]),
        grid=np.array([1, 1]),
        child=np.array([1, -1, -1, -1, -1], np.int32),
        corner=np.arange(20, dtype=np.int32).reshape(5, 4),
        metric_root=np.ones((20, 4)),
    )
    Background(**arrays)
    with pytest.raises(ValueError, match=message):
        Background(**(arrays | wrong))


def test_copies_are_equal_and_arrays_cannot_be_written_to():
    tree = random_tree(1, 2, 2, 3)
    same = pickle.loads(pickle.dumps(tree))
    for name in ("box", "grid", "child", "corner", "metric_root"):
        np.testing.assert_array_equal(getattr(same, name), getattr(tree, name))
        with pytest.raises(ValueError, match="read-only"):
            getattr(same, name)[0] = 0
