"""Diagonals of boxes, Gauss's rule, loops in loops."""

import math

import numpy as np
import pytest

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
