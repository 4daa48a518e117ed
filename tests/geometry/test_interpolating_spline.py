"""Splines and Gauss's rule against scipy's and numpy's, which go through LAPACK."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import make_interp_spline

from surfmesh.geometry.interpolating_spline import interpolating_spline
from surfmesh.geometry.quadrature import gauss_rule, unit_rule


@given(seed=st.integers(0, 300), degree=st.sampled_from([1, 3, 5, 7]), more=st.integers(0, 60))
def test_it_is_the_spline_of_scipy(seed, degree, more):
    draw = np.random.default_rng(seed)
    x = np.cumsum(draw.uniform(0.5, 1.5, size=degree + 1 + more))
    y = draw.normal(size=(len(x), 2))
    found, expected = interpolating_spline(x, y, degree), make_interp_spline(x, y, k=degree)
    assert np.array_equal(found.t, expected.t)
    assert np.allclose(found(x), y, atol=1e-11)
    at = np.linspace(x[0], x[-1], 97)
    assert np.allclose(found(at), expected(at), atol=1e-9)


@pytest.mark.parametrize("points", [1, 2, 5, 8, 16, 31])
def test_the_rule_is_exact_for_polynomials(points):
    nodes, weights = unit_rule(points)
    known, known_weights = np.polynomial.legendre.leggauss(points)
    assert np.allclose(nodes, known, rtol=0, atol=1e-15)
    assert np.allclose(weights, known_weights, rtol=1e-13)
    x, w = gauss_rule(1.0, 3.0, 2, points)
    degree = 2 * points - 1
    assert (w * x**degree).sum() == pytest.approx((3.0 ** (degree + 1) - 1.0) / (degree + 1))
