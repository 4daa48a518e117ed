"""The least and the largest angle of triangles, against arc tangents at all three corners."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from surfmesh._core.space import triangle_shapes


def angles(points):
    """(3,) of one triangle (3, 3), degrees."""
    ab, ac, bc = points[1] - points[0], points[2] - points[0], points[2] - points[1]
    twice_area = np.linalg.norm(np.cross(ab, ac))
    return np.degrees(np.arctan2(twice_area, [ab @ ac, -(ab @ bc), ac @ bc]))


@given(st.integers(0, 2**31), st.sampled_from([1.0, 1e-3, 1e-6, 1e-9, 1e-14, 0.0]), st.booleans())
def test_flat_long_and_nearly_even_triangles(seed, part, is_even):
    draw = np.random.default_rng(seed)
    points = draw.normal(size=(3, 3))
    if is_even:
        points = np.eye(3) + part * points
    else:
        points[2] = points[0] + draw.uniform(-1, 2) * (points[1] - points[0]) + part * points[2]
    expected = angles(points)
    for order in ((0, 1, 2), (2, 0, 1), (1, 0, 2)):
        shape = triangle_shapes(points[list(order)], np.array([[0, 1, 2]], np.int32))
        np.testing.assert_allclose(shape[3], expected.min(), rtol=1e-6, atol=1e-10)
        np.testing.assert_allclose(shape[4], expected.max(), rtol=1e-6, atol=1e-10)


def test_a_triangle_whose_corners_are_two_points_has_a_straight_angle():
    points = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)])
    for corners in ((0, 0, 1), (0, 1, 0), (1, 0, 0)):
        *_, least, largest = triangle_shapes(points, np.array([corners], np.int32))
        assert least[0] == 0.0 and largest[0] in (0.0, 180.0)


def test_a_triangle_that_repeats_a_corner_has_a_straight_angle_in_space():
    points = np.array([(0.1, 0.2, 0.3), (0.7, 0.5, 0.2)])
    *_, largest = triangle_shapes(points, np.array([(0, 0, 1)], np.int32))
    assert largest[0] == 180.0


def test_many_triangles_have_the_angles_of_each_alone():
    draw = np.random.default_rng(5)
    points = draw.normal(size=(300, 3))
    triangles = draw.integers(0, 300, (1000, 3)).astype(np.int32)  # some without area
    together = np.array(triangle_shapes(points, triangles))
    alone = [np.array(triangle_shapes(points, row[None])) for row in triangles]
    assert np.array_equal(together, np.concatenate(alone, axis=1))
