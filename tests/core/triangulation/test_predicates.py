"""The sign of orient against rational arithmetic."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from naive import exact

from surfmesh._core.triangulation import orient

coordinate = st.floats(-1.0, 1.0, allow_subnormal=False)
scale = st.sampled_from([1e-9, 1e-3, 1.0, 1e3, 1e9])
tiny = st.integers(-4, 4)


def agrees(a, b, c) -> bool:
    return exact.sign(orient(*a, *b, *c)) == exact.sign(exact.orient(a, b, c))


def underflows(*numbers) -> bool:
    """Would a product of two be subnormal? No coordinates of a mesh are that small."""
    return any(0 < abs(x) < 1e-100 for x in numbers)


@settings(max_examples=300)
@given(st.tuples(*[coordinate] * 6), scale)
def test_any_points(numbers, factor):
    ax, ay, bx, by, cx, cy = (factor * x for x in numbers)
    assume(not underflows(ax, ay, bx, by, cx, cy))
    assert agrees((ax, ay), (bx, by), (cx, cy))


@settings(max_examples=400)
@given(coordinate, coordinate, coordinate, coordinate, st.floats(-2, 2), tiny, tiny, scale)
def test_nearly_collinear(ax, ay, bx, by, s, i, j, factor):
    """c on the line ab but for a few units in the last place."""
    a, b = np.array([ax, ay]) * factor, np.array([bx, by]) * factor
    c = a + s * (b - a)
    c = c + np.array([i, j]) * np.spacing(np.abs(c).max())
    assume(not underflows(*a, *b, *c))
    assert agrees(a, b, c) and agrees(b, c, a) and agrees(c, a, b)


@settings(max_examples=100)
@given(st.tuples(*[st.integers(-(2**20), 2**20)] * 5), scale)
def test_collinear_by_construction(numbers, factor):
    """Integer multiples of one integer step are on one line, also in floats."""
    x, y, dx, dy, k = numbers
    power = 2.0 ** int(np.log2(factor))
    points = [(power * (x + m * dx), power * (y + m * dy)) for m in (0, k % 17, 1 + k % 5)]
    assert orient(*points[0], *points[1], *points[2]) == 0.0


@pytest.mark.parametrize("factor", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("offset", [0.0, 1 / 3, 1e6])
def test_parallel_to_an_axis(factor, offset):
    t = factor * (offset + np.array([0.1, 0.2, 0.7]))
    for order in ([0, 1, 2], [1, 0, 2], [2, 1, 0]):
        p, q, r = t[order]
        assert orient(p, factor, q, factor, r, factor) == 0.0
        assert orient(factor, p, factor, q, factor, r) == 0.0
        assert agrees((p, factor), (q, factor), (r, np.nextafter(factor, np.inf)))
        assert agrees((factor, p), (factor, q), (np.nextafter(factor, 0), r))


@settings(max_examples=200)
@given(st.tuples(*[coordinate] * 4), tiny, tiny)
def test_antisymmetric_and_cyclic(numbers, i, j):
    ax, ay, bx, by = numbers
    cx = 0.5 * (ax + bx) + i * 2.0**-54
    cy = 0.5 * (ay + by) + j * 2.0**-54
    a, b, c = (ax, ay), (bx, by), (cx, cy)
    s = exact.sign(orient(*a, *b, *c))
    assert exact.sign(orient(*b, *c, *a)) == s
    assert exact.sign(orient(*b, *a, *c)) == -s
    assert exact.sign(orient(*a, *c, *b)) == -s


def test_value_away_from_zero_is_twice_the_area():
    assert orient(0.0, 0.0, 2.0, 0.0, 0.0, 3.0) == 6.0


def test_far_from_the_origin():
    """A grid of last places about (12, 12) and the line y = x: filters alone get this wrong."""
    unit = 2.0**-53
    for i in range(0, 64, 7):
        for j in range(0, 64, 5):
            a = (0.5 + i * unit, 0.5 + j * unit)
            assert agrees(a, (12.0, 12.0), (24.0, 24.0))


@settings(max_examples=300)
@given(st.tuples(*[coordinate] * 4), st.integers(-45, 45), st.integers(-45, 45), tiny, tiny)
def test_differences_that_are_rounded(numbers, near, far, i, j):
    """Points on a line at distances of other sizes than their coordinates: all stages decide."""
    cx, cy, dx, dy = numbers
    assume(not underflows(*numbers))
    c, d = np.array([cx, cy]), np.array([dx, dy])
    a = c + 2.0**near * d
    b = c + 2.0**far * d
    b += np.array([i, j]) * np.spacing(np.abs(b).max())
    assert agrees(a, b, c) and agrees(c, a, b) and agrees(b, c, a)
