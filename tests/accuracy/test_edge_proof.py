"""Proved distances of segments from curves that bend more than they need to."""

import numpy as np
import pytest

from surfmesh._core.proof import curve_bounds
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve


def graded_parabola(noise):
    """(t, t^2, 0) in cubic pieces that halve towards t = 1, as in approximations of offsets."""
    knots = np.concatenate([[0.0], 1.0 - 0.5 ** np.arange(1, 24), [1.0]])
    a, b = knots[:-1], knots[1:]
    third = (b - a) / 3.0
    x = np.stack([a, a + third, b - third], axis=1)
    y = np.stack([a * a, a * a + 2.0 * a * third, b * b - 2.0 * b * third], axis=1)
    control = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    control = np.concatenate([control, [[1.0, 1.0, 0.0]]])
    control += noise * np.random.default_rng(0).uniform(-1.0, 1.0, control.shape)
    return BSplineCurve(np.concatenate([[0.0], np.repeat(knots, 3), [1.0]]), control)


@pytest.mark.parametrize("noise", [0.0, 1e-8, 1e-6])
def test_segments_of_an_approximation_are_as_near_as_is_proved(noise):
    curve = graded_parabola(noise)
    t = np.stack([np.linspace(0.0, 0.9, 10), np.linspace(0.1, 1.0, 10)], axis=1)
    at = t[:, :1] + (t[:, 1:] - t[:, :1]) * np.linspace(0.0, 1.0, 400)
    points = curve.evaluate(at.ravel(), 0)[0].reshape(*at.shape, 3)
    start, end = points[:, 0], points[:, -1]
    side = (end - start) / np.linalg.norm(end - start, axis=1)[:, None]
    away = points - start[:, None]
    far = np.linalg.norm(np.cross(away, side[:, None]), axis=2).max(axis=1)
    bound = curve_bounds(curve.core, t, np.ascontiguousarray(points[:, (0, -1)]))
    assert (far <= bound).all()
    assert (bound <= 2.0 * far + 4.0 * noise + 1e-12).all()
