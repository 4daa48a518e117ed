"""Orientation in space against fractions for all finite numbers: subnormal, huge, both at once."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import exact, meeting
from naive.numbers_of_any_size import few, powers, sized, small

from surfmesh._core.space import orient_space, triangles_meet

spread = st.integers(-40, 40)


def right_in_space(points) -> bool:
    found = orient_space(np.array(points, float))
    return exact.sign(found) == exact.sign(meeting.orient_space(*points))


@settings(max_examples=300)
@given(st.lists(st.tuples(sized, sized, sized), min_size=4, max_size=4))
def test_any_four_points(points):
    assert right_in_space(points)


@settings(max_examples=200)
@given(st.tuples(*[small] * 9), few, few, few, st.tuples(powers, powers, powers))
def test_nearly_in_a_plane_at_any_scale(numbers, s, t, last, scales):
    a, b, c = np.array(numbers).reshape(3, 3)
    d = a + s * (b - a) + t * (c - a) + np.array([0, 0, last])
    points = [tuple(math.ldexp(int(x), k) for x, k in zip(p, scales)) for p in (a, b, c, d)]
    assert right_in_space(points)
    assert right_in_space([points[k] for k in (3, 1, 0, 2)])


@settings(max_examples=300)
@given(st.tuples(*[st.floats(-1, 1, allow_subnormal=False)] * 9), st.tuples(*[spread] * 4), few)
def test_differences_that_are_rounded(numbers, powers, last):
    """Points in a plane at distances of other sizes than their coordinates: all stages decide."""
    numbers = [x if abs(x) > 1e-60 else 0.0 for x in numbers]
    a, p, q = np.array(numbers).reshape(3, 3)
    i, j, k, n = (2.0**m for m in powers)
    b, c, d = a + i * p, a + j * q, a + k * p - n * q
    d[2] += last * np.spacing(np.abs(d).max())
    assert right_in_space([a, b, c, d])
    assert right_in_space([d, c, b, a])


@settings(max_examples=150)
@given(st.lists(st.tuples(few, few, few), min_size=6, max_size=6), st.sampled_from(
    [2.0**-1074, 2.0**-1022, 1e-200, 1e-160, 1e-108, 1e-9, 1e9, 1e108, 1e150, 5e307]))  # fmt: skip
def test_triangles_meet_at_any_scale(points, scale):
    corners = scale * np.array(points, float)
    found = triangles_meet(corners)
    assert found == meeting.meet(points[:3], points[3:])


def test_what_is_not_finite_is_nan():
    corners = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, math.inf]])
    assert math.isnan(orient_space(corners))
