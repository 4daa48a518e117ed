"""Triangles of many faces in one row."""

import numpy as np
import pytest

from surfmesh._core.faces import triangles_in_a_row


def test_corners_are_numbered_on_and_turned():
    parts = [
        np.array(rows, np.int32).reshape(-1, 3) for rows in ([0, 1, 2, 2, 1, 3], [], [0, 2, 1])
    ]
    found = triangles_in_a_row(parts, np.array([4, 1, 3]), np.array([0, 1, 1], np.uint8))
    assert found.dtype == np.int64
    assert found.tolist() == [[0, 1, 2], [2, 1, 3], [5, 6, 7]]
    assert triangles_in_a_row([], np.empty(0, np.int64), np.empty(0, np.uint8)).shape == (0, 3)


def test_what_does_not_fit_is_refused():
    part, none = np.zeros((1, 3), np.int32), np.zeros(0, np.uint8)
    with pytest.raises(ValueError, match="points"):
        triangles_in_a_row([part], np.empty(0, np.int64), none)
    with pytest.raises(ValueError, match="turned"):
        triangles_in_a_row([part], np.array([3]), none)
    with pytest.raises(TypeError):
        triangles_in_a_row([None], np.array([3]), np.zeros(1, np.uint8))
