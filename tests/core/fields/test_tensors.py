"""Size tensors against numpy's linear algebra."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from naive import metric

from surfmesh._core.fields import edge_lengths, shape, solve, triangle_shape


def random_tensors(seed, n, stretch=1e3):
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, np.pi, n)
    p, q = stretch ** rng.uniform(-1, 1, (2, n))
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([p * c * c + q * s * s, (p - q) * c * s, p * s * s + q * c * c], axis=1)


@given(st.integers(0, 10_000))
def test_lengths(seed):
    h = random_tensors(seed, 2)
    xy = np.random.default_rng(seed + 1).normal(size=(2, 2))
    expected = metric.length(*xy, *h)
    both_ways = edge_lengths(xy, h, np.array([[0, 1], [1, 0]], np.int32))
    assert tuple(both_ways) == pytest.approx((expected, expected), rel=1e-8)
    assert solve(tuple(h[0]), 1.0, 2.0) == pytest.approx(
        np.linalg.solve(metric.matrix(h[0]), [1.0, 2.0]), rel=1e-7, abs=1e-9
    )


@given(st.integers(0, 10_000))
def test_shape_is_measured_in_the_mean_metric(seed):
    h = random_tensors(seed, 3)
    xy = np.random.default_rng(seed + 1).normal(size=(3, 2))
    back = np.linalg.solve(metric.matrix(h.sum(axis=0)), xy.T).T
    assert triangle_shape(xy, h) == pytest.approx(metric.alpha(*back), abs=1e-7)


def test_shape_of_known_triangles():
    assert shape(1.0, 0.0, 0.5, np.sqrt(0.75)) == pytest.approx(1.0)
    assert shape(0.5, np.sqrt(0.75), 1.0, 0.0) == pytest.approx(-1.0)
    assert shape(1.0, 0.0, 0.0, 1.0) == pytest.approx(np.sqrt(0.75))
    assert shape(1.0, 0.0, 2.0, 0.0) == 0.0
    assert shape(0.0, 0.0, 0.0, 0.0) == 0.0
