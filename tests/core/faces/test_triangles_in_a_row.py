"""Triangles of many faces in one row."""

import numpy as np
import pytest

from surfmesh._core.faces import are_corners, triangles_in_a_row
from surfmesh.meshing.processors import allowed_threads


def test_corners_are_numbered_on_and_turned():
    parts = [
        np.array(rows, np.int32).reshape(-1, 3) for rows in ([0, 1, 2, 2, 1, 3], [], [0, 2, 1])
    ]
    found = triangles_in_a_row(parts, np.array([4, 1, 3]), np.array([0, 1, 1], np.uint8))
    assert found.dtype == np.int32
    assert found.tolist() == [[0, 1, 2], [2, 1, 3], [5, 6, 7]]
    names = np.arange(10, 18, dtype=np.int32)
    named = triangles_in_a_row(parts, np.array([4, 1, 3]), np.array([0, 1, 1], np.uint8), names)
    assert (named == found + 10).all()
    assert triangles_in_a_row([], np.empty(0, np.int64), np.empty(0, np.uint8)).shape == (0, 3)


def test_what_does_not_fit_is_refused():
    part, none = np.zeros((1, 3), np.int32), np.zeros(0, np.uint8)
    with pytest.raises(ValueError, match="points"):
        triangles_in_a_row([part], np.empty(0, np.int64), none)
    with pytest.raises(ValueError, match="turned"):
        triangles_in_a_row([part], np.array([3]), none)
    with pytest.raises(TypeError):
        triangles_in_a_row([None], np.array([3]), np.zeros(1, np.uint8))
    with pytest.raises(ValueError, match="names"):
        triangles_in_a_row([part], np.array([3]), np.zeros(1, np.uint8), np.zeros(2, np.int32))
    with pytest.raises(ValueError, match="out of range"):
        triangles_in_a_row([part + 3], np.array([3]), np.zeros(1, np.uint8))
    with pytest.raises(ValueError, match="int32"):
        triangles_in_a_row([part, part], np.full(2, 2**31 - 1), np.zeros(2, np.uint8))


def test_points_that_are_corners():
    parts = [np.array([[0, 2, 3]], np.int32), np.empty((0, 3), np.int32)]
    assert are_corners(parts, np.array([5, 2])).tolist() == [1, 0, 1, 1, 0, 0, 0]


def test_many_parts_are_the_same_with_any_number_of_threads():
    rng = np.random.default_rng(3)
    points = rng.integers(3, 400, 900)
    parts = [rng.integers(0, n, (2 * n, 3), dtype=np.int32) for n in points.tolist()]
    turned = rng.integers(0, 2, 900).astype(np.uint8)
    made = []
    for threads in (1, 2, 7):
        with allowed_threads(threads):
            made.append((triangles_in_a_row(parts, points, turned), are_corners(parts, points)))
    for row, corners in made[1:]:
        assert (row == made[0][0]).all() and (corners == made[0][1]).all()
