"""Lengths, shapes and steps in an anisotropic metric, against numpy."""

import numpy as np
import pytest
from naive.background import replaced, uniform_background
from naive.metric import alpha, metric_root_3d

from surfmesh._core.optimisation import (
    SurfaceFrames,
    chord,
    edge_length,
    lift,
    shorten,
    triangle_shape,
)
from surfmesh._core.triangulation import Triangulation


def embedded(seed=0, ratio=30.0):
    """Four vertices of a plane in space that (x, y) is stretched onto, sizes along a line in it."""
    rng = np.random.default_rng(seed)
    jacobian = rng.normal(size=(3, 2))
    normal = np.cross(*jacobian.T)
    normal /= np.linalg.norm(normal)
    t = jacobian @ rng.normal(size=2)
    t /= np.linalg.norm(t)
    w = 5.0 * (np.eye(3) - (1 - 1 / ratio) * np.outer(t, t))
    six = w[[0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]]
    xy = rng.uniform(0, 1, (4, 2))
    background = uniform_background(np.tile([1.0, 0.0, 1.0, 5.0], (2, 2, 1)), 1.0, 1.0)
    background = replaced(background, metric_root_3d=np.tile(six, (4, 1)))
    none = np.empty(0, np.int32), np.empty(0, np.int32), *[np.empty(0, np.uint8)] * 2
    mesh, s = Triangulation(xy, np.zeros((4, 3)), *none), SurfaceFrames(4, True)
    points = xy @ jacobian.T
    rx, ry = (np.tile(column, (4, 1)) for column in jacobian.T)
    s.set(mesh, background, np.arange(4, dtype=np.int32), points, rx, ry, 1e6)
    return mesh, s, jacobian, w, points, background


@pytest.mark.parametrize("seed", range(5))
def test_size_tensor_chart_and_steps(seed):
    mesh, s, jacobian, w, points, _ = embedded(seed)
    h = mesh.size[0]
    tensor = np.array([[h[0], h[1]], [h[1], h[2]]])
    np.testing.assert_allclose(
        np.linalg.inv(tensor @ tensor), jacobian.T @ w @ w @ jacobian, rtol=1e-9
    )
    step = np.array(chord(s, 0, 1))
    assert np.linalg.norm(step) == pytest.approx(np.linalg.norm(w @ (points[1] - points[0])))
    np.testing.assert_allclose(np.linalg.solve(tensor, mesh.xy[1] - mesh.xy[0]), step, rtol=1e-8)
    np.testing.assert_allclose(lift(s, 0, *step), points[1] - points[0], rtol=1e-8)


@pytest.mark.parametrize("seed", range(5))
def test_lengths_and_shapes(seed):
    _, s, _, w, points, _ = embedded(seed)
    assert edge_length(s, 0, 1) == pytest.approx(np.linalg.norm(w @ (points[1] - points[0])))
    a, b, c = (np.array(chord(s, 0, k)) for k in (0, 1, 2))
    expected = alpha(a, b, c)
    assert abs(triangle_shape(s, 0, 1, 2)) == pytest.approx(abs(expected))
    assert triangle_shape(s, 0, 1, 2) == pytest.approx(-triangle_shape(s, 0, 2, 1))
    before = edge_length(s, 0, 1)
    shorten(s, 0, 0.5)
    shorten(s, 1, 0.5)
    assert edge_length(s, 0, 1) == pytest.approx(2 * before)


def test_the_background_interpolates_w():
    *_, w, _, background = embedded()
    places = np.random.default_rng(0).uniform(0, 1, (3, 2))
    for row in background.metric_roots_3d(places):
        np.testing.assert_allclose(metric_root_3d(row), w, rtol=1e-12)


def test_where_a_surface_stands_still_sizes_are_finite():
    """As at the pole of (v^2 cos(u), v^2 sin(u), v^2), where both derivatives are 0."""
    mesh, s, _, _, points, background = embedded()
    s = SurfaceFrames(4, False)
    still = np.zeros((4, 3))
    s.set(mesh, background, np.arange(4, dtype=np.int32), points, still, still, 1e6)
    assert np.isfinite(mesh.size).all()
    assert np.isfinite(chord(s, 0, 1)).all() and np.isfinite(lift(s, 0, 1.0, 0.0)).all()
