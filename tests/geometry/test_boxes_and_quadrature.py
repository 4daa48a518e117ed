"""Diagonals of boxes, Gauss's rule, loops in loops."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.inside_loops import is_inside, nesting_depth
from surfmesh.geometry.quadrature import gauss_rule

SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])


def test_a_diagonal_is_that_of_the_box():
    assert diagonal(np.array([(1.0, 2.0, 3.0), (3.0, 5.0, 9.0), (2.0, 2.0, 4.0)])) == 7.0
    assert diagonal(3.0 * SQUARE) == math.hypot(3.0, 3.0)
    assert diagonal(np.empty((0, 3))) == 0.0


@pytest.mark.parametrize("points", [1, 2, 5])
def test_the_rule_is_exact_up_to_its_degree(points):
    places, weights = gauss_rule(-1.0, 3.0, 3, points)
    assert len(places) == len(weights) == 3 * points
    for power in range(2 * points):
        exact = (3.0 ** (power + 1) - (-1.0) ** (power + 1)) / (power + 1)
        assert weights @ places**power == pytest.approx(exact, rel=1e-13)
    power = 2 * points  # and no further
    places, weights = gauss_rule(-1.0, 3.0, 1, points)
    exact = (3.0 ** (power + 1) + 1.0) / (power + 1)
    assert weights @ places**power != pytest.approx(exact, rel=1e-8)


def test_loops_lie_in_loops_by_even_and_odd():
    loops = [0.4 * SQUARE + 0.3, 4.0 * SQUARE - 1.5, SQUARE]
    assert nesting_depth(loops).tolist() == [2, 0, 1]
    points = np.array([(0.5, 0.5), (0.1, 0.1), (2.0, 2.0), (9.0, 0.0)])
    assert is_inside(loops, points).tolist() == [True, False, True, False]


@given(seed=st.integers(0, 10_000))
def test_points_within_loops_are_those_that_shapely_finds(seed):
    draw = np.random.default_rng(seed)
    loops = [  # stars: they do not cross themselves; corners on a grid, where points lie on sides
        np.round(draw.uniform(-3, 3, 2) + draw.uniform(0.5, 4, (n, 1)) * np.stack(
            [np.cos(a := np.sort(draw.uniform(0, 2 * np.pi, n))), np.sin(a)], axis=1
        ), int(draw.integers(0, 3)))
        for n in draw.integers(2, 12, size=3)
    ]  # fmt: skip
    points = np.concatenate([np.round(draw.uniform(-6, 6, (200, 2))), draw.uniform(-6, 6, (99, 2))])
    expected = np.zeros(len(points), bool)
    for loop in loops:
        outline = shapely.Polygon(loop) if len(loop) > 2 else shapely.Polygon()
        if not outline.is_valid:
            return
        expected ^= shapely.contains_xy(outline, *points.T)
    assert np.array_equal(is_inside(loops, points), expected)


def test_what_is_not_finite_lies_in_no_loop():
    points = np.array([(np.nan, 0.5), (0.5, np.inf), (0.5, 0.5)])
    assert is_inside([SQUARE], points).tolist() == [False, False, True]
    with pytest.raises(ValueError, match="not finite"):
        is_inside([np.full((3, 2), np.nan)], points)
