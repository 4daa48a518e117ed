"""Small matrices against numpy's own, which go through BLAS and LAPACK."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfmesh.geometry.small_matrices import (
    least_squares,
    norm,
    product,
    pseudo_inverse,
    symmetric_axes,
    thin_svd,
)

SHAPES = [(3, 3), (4, 3), (2, 3), (5, 4), (1, 3), (3, 1)]


@pytest.mark.parametrize(
    "a, b", [((3,), (3,)), ((4, 3), (3,)), ((3,), (3, 2)), ((4, 3), (3, 2)), ((5, 3), (7, 3, 2))]
)
def test_products(a, b):
    draw = np.random.default_rng(1)
    one, two = draw.normal(size=a), draw.normal(size=b)
    assert np.allclose(product(one, two), one @ two, rtol=1e-14)


@given(seed=st.integers(0, 200), shape=st.sampled_from(SHAPES), rank=st.integers(0, 3))
def test_decompositions_give_the_matrix_back(seed, shape, rank):
    draw = np.random.default_rng(seed)
    a = draw.normal(size=(6, *shape)) * 10.0 ** draw.uniform(-3, 3)
    if rank < min(shape):
        a = draw.normal(size=(6, shape[0], rank)) @ draw.normal(size=(6, rank, shape[1]))
    u, s, v = thin_svd(a)
    assert u.shape[-1] == s.shape[-1] == v.shape[-2] == min(shape)
    size = np.abs(a).max(initial=1e-300)
    assert np.allclose((u * s[..., None, :]) @ v, a, atol=1e-13 * size)
    assert np.allclose(s, np.linalg.svd(a, compute_uv=False), atol=1e-13 * size)
    assert np.allclose(pseudo_inverse(a, 1e-9), np.linalg.pinv(a, rcond=1e-9), atol=1e-6 / size)


@given(seed=st.integers(0, 200))
def test_equations_that_are_too_many_or_dependent(seed):
    draw = np.random.default_rng(seed)
    a, b = draw.normal(size=(4, 3)), draw.normal(size=4)
    a[:, 2] = a[:, 0] if seed % 2 else a[:, 2]
    assert np.allclose(least_squares(a, b, 1e-9), np.linalg.lstsq(a, b, rcond=1e-9)[0])


@given(a=st.floats(-9, 9), b=st.floats(-9, 9), c=st.sampled_from([0.0, 1e-12, 0.3, -7.0]))
def test_axes_of_symmetric_matrices(a, b, c):
    matrix = np.array([[a, c], [c, b]])
    values, axes = symmetric_axes(matrix)
    assert values[0] <= values[1] and np.allclose(axes.T @ axes, np.eye(2))
    assert np.allclose(matrix @ axes, axes * values, atol=1e-13 * max(abs(a), abs(b), 1.0))


def test_lengths_neither_overflow_nor_vanish():
    assert norm([3e200, 4e200]) == pytest.approx(5e200) and norm([3e-200, 4e-200]) > 4e-200
    assert norm([]) == 0.0 and norm([[3.0], [4.0]]) == 5.0
    assert np.isnan(norm([np.nan, 1.0])) and norm([np.inf, 1.0]) == np.inf
