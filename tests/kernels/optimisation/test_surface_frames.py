"""Lengths, shapes and steps in an anisotropic metric, against numpy."""

import numpy as np
import pytest
from naive.background import replaced, uniform_background
from naive.metric import alpha, metric_root_3d

from surfmesh.kernels.fields.background import for_kernels, metric_roots_3d_at
from surfmesh.kernels.optimisation.surface_frames import (
    chord,
    edge_length,
    empty_frames,
    lift,
    set_frames,
    shorten,
    triangle_shape,
)
from surfmesh.kernels.triangulation.triangulation import empty_triangulation


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
    background = for_kernels(replaced(background, metric_root_3d=np.tile(six, (4, 1))))
    mesh = empty_triangulation(8)
    mesh.xy[:4] = xy
    mesh.count[0] = 4
    s = empty_frames(8, True)
    points = xy @ jacobian.T
    rx, ry = (np.tile(column, (4, 1)) for column in jacobian.T)
    set_frames(mesh, s, background, np.arange(4, dtype=np.int32), points, rx, ry, 1e6)
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
    found = np.empty((3, 6))
    metric_roots_3d_at(background, np.random.default_rng(0).uniform(0, 1, (3, 2)), found)
    for row in found:
        np.testing.assert_allclose(metric_root_3d(row), w, rtol=1e-12)
