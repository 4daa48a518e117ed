"""Predicates against fractions for all finite numbers: subnormal, huge, and both at once."""

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import exact
from naive.numbers_of_any_size import few, powers, sized, small

from surfmesh._core.triangulation import exact_sum, orient


def right_in_the_plane(*points) -> bool:
    return exact.sign(orient(*itertools.chain(*points))) == exact.sign(exact.orient(*points))


@settings(max_examples=400)
@given(st.lists(st.tuples(sized, sized), min_size=3, max_size=3))
def test_any_three_points(points):
    assert right_in_the_plane(*points)


@settings(max_examples=300)
@given(st.tuples(*[small] * 4), few, few, few, powers, powers)
def test_nearly_on_a_line_at_any_scale(numbers, times, i, j, across, up):
    """A third point on the line through two but for some last places; each axis has its scale."""
    x, y, dx, dy = numbers
    places = [(x, y), (x + dx, y + dy), (x + times * dx + i, y + times * dy + j)]
    points = [(math.ldexp(a, across), math.ldexp(b, up)) for a, b in places]
    for p, q, r in itertools.permutations(points):
        assert right_in_the_plane(p, q, r)


@settings(max_examples=150)
@given(st.tuples(*[sized] * 4), st.integers(-2, 2))
def test_between_two_points_of_any_size(numbers, last):
    ax, ay, bx, by = (x / 4 for x in numbers)
    c = (0.5 * (ax + bx), 0.5 * (ay + by))
    for _ in range(abs(last)):
        c = (c[0], math.nextafter(c[1], math.copysign(math.inf, last)))
    assert right_in_the_plane((ax, ay), (bx, by), c)


@settings(max_examples=300)
@given(st.lists(st.tuples(st.integers(-(2**53), 2**53), st.integers(-2000, 2000)), min_size=1,
                max_size=96))  # fmt: skip
def test_sum_of_numbers_with_exponents_of_their_own(pairs):
    terms = np.array([float(m) for m, _ in pairs])
    exponents = np.array([e for _, e in pairs])
    true = sum(Fraction(m) * Fraction(2) ** e for m, e in pairs)
    assert exact.sign(exact_sum(terms, exponents)) == exact.sign(true)


@pytest.mark.parametrize("many", [1, 2, 47])
def test_sum_that_cancels_down_to_its_last_place(many):
    """2 - 1 - 1/2 - 1/4 ... and a last unit: undecided until the end."""
    for last in (-1.0, 0.0, 1.0):
        terms = [1.0, *[-1.0] * many, last]
        exponents = [0, *range(-1, -many - 1, -1), -many]
        true = 2.0**-many + last * 2.0**-many
        found = exact_sum(np.array(terms), np.array(exponents))
        assert exact.sign(found) == exact.sign(true)


def test_sizes_that_are_no_doubles():
    tiny, huge = 2.0**-1074, 2.0**1000
    assert orient(0.0, 0.0, tiny, 0.0, 0.0, tiny) == 5e-324
    assert orient(0.0, 0.0, 0.0, huge, huge, 0.0) == -1.7976931348623157e308
    assert orient(0.0, 0.0, tiny, 0.0, 0.0, huge) == 2.0**-74
    assert math.isnan(orient(0.0, 0.0, math.inf, 0.0, 0.0, 1.0))
    assert math.isnan(orient(0.0, 0.0, tiny, math.nan, 0.0, 1.0))
