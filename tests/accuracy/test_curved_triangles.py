"""Distances of quadratic triangles and arcs, against closed forms."""

import numpy as np
import pytest

from surfmesh.accuracy.curved_triangles import WITHIN, arc_deviations, points_on, shape_functions


def circle(t):
    angle = 0.8 * t
    at = np.stack([np.cos(angle), np.sin(angle), 0 * t], axis=1)
    return at, 0.8 * np.stack([-np.sin(angle), np.cos(angle), 0 * t], axis=1)


def test_a_parabola_misses_its_circle_by_its_closed_form():
    """R (1 - cos a)^2 / 8 for a half angle a, at t^2 = 1/2 of it."""
    ends, middle = (circle(np.array([t]))[0][0] for t in (0.0, 1.0)), circle(np.array([0.5]))[0][0]
    start, end = ends
    nodes = np.array([[start, middle, end]])
    distance, place = arc_deviations(circle, nodes)
    exact = (1.0 - np.cos(0.4)) ** 2 / 8.0
    assert 0.95 * exact < distance[0] <= 1.001 * exact
    assert abs(np.hypot(*place[0, :2]) - 1.0) == pytest.approx(distance[0], rel=1e-9)


def test_functions_are_one_together_and_nodes_are_their_own():
    np.testing.assert_allclose(shape_functions(WITHIN).sum(axis=1), 1.0, rtol=1e-14)
    nodes = np.random.default_rng(3).normal(size=(2, 6, 3))
    corners = np.vstack([np.eye(3), [(0.5, 0.5, 0), (0, 0.5, 0.5), (0.5, 0, 0.5)]])
    np.testing.assert_allclose(points_on(nodes, corners), nodes, atol=1e-15)
