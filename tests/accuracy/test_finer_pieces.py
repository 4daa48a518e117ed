"""Faces cut further: triangles stay what they are, and points move no faster than is said."""

import numpy as np

from surfmesh.accuracy.finer_pieces import PATTERNS, linear_moves


def test_each_pattern_covers_its_triangle_the_same_way_round():
    corners = np.array([(0, 0), (1, 0), (0, 1)], float)
    six = np.concatenate([corners, 0.5 * (corners + corners[[1, 2, 0]])])
    for bits, triangles in enumerate(PATTERNS):
        a, b, c = (six[list(k)] for k in zip(*triangles, strict=True))
        area = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
        assert (area > 0.0).all() and np.isclose(area.sum(), 0.5)
        used = {corner for triangle in triangles for corner in triangle}
        assert used == {0, 1, 2} | {3 + k for k in range(3) if bits >> k & 1}


def test_points_move_no_faster_than_is_said():
    draw = np.random.default_rng(1)
    corners, move = draw.normal(size=(2, 50, 3, 3))
    away, slope = linear_moves(corners, move)
    one, other = draw.dirichlet((1.0, 1.0, 1.0), (2, 200))
    for x, h in ((corners, move),):
        apart = np.linalg.norm(np.einsum("qk,mkd->mqd", one - other, x), axis=2)
        change = np.linalg.norm(np.einsum("qk,mkd->mqd", one - other, h), axis=2)
        assert (change <= slope[:, None] * apart).all()
        assert (np.linalg.norm(np.einsum("qk,mkd->mqd", one, h), axis=2) <= away[:, None]).all()
    assert (change.max(axis=1) > 0.0).all()


def test_triangles_without_area_move_as_fast_as_you_like():
    corners = np.array([[(0, 0, 0), (1, 0, 0), (2, 0, 0)]], float)
    _, slope = linear_moves(corners, np.ones((1, 3, 3)))
    assert np.isinf(slope).all()
