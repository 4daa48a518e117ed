"""Planes of triangles against numpy."""

import numpy as np
import pytest

from surfmesh._core.space import triangle_planes


def test_planes_are_those_of_numpy():
    rng = np.random.default_rng(0)
    points = rng.normal(size=(20, 3))
    triangles = rng.integers(0, 20, (40, 3)).astype(np.int32)
    triangles[3] = 7
    chosen = rng.permutation(40)[:25].astype(np.int32)
    normal, area, longest = triangle_planes(points, triangles, chosen)
    corners = points[triangles[chosen]]
    wanted = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (area == np.linalg.norm(wanted, axis=1)).all()
    sides = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2)
    assert (longest == sides.max(axis=1)).all()
    assert (normal[area > 0] == (wanted[area > 0] / area[area > 0, None])).all()
    assert (normal[area == 0] == 0).all()


def test_what_is_out_of_range_is_refused():
    one = np.array([[0, 1, 2]], np.int32)
    with pytest.raises(ValueError, match="out of range"):
        triangle_planes(np.zeros((3, 3)), one, np.ones(1, np.int32))
    with pytest.raises(ValueError, match="out of range"):
        triangle_planes(np.zeros((2, 3)), one, np.zeros(1, np.int32))
