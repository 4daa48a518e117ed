"""The curve that a surface makes of a p-curve: a helix on a cylinder; derivatives."""

import pickle

import numpy as np
import pytest

from surfmesh._core.proof import curve_bounds
from surfmesh.geometry.cad_surfaces.curve_on_surface import CurveOnSurface
from surfmesh.geometry.cad_surfaces.curves import Circle, Line
from surfmesh.geometry.cad_surfaces.elementary import Cylinder, Torus

X, Y, Z = np.eye(3)
CYLINDER = Cylinder(np.zeros(3), X, Y, Z, radius=2.0, domain=((0.0, 6.0), (0.0, 6.0)))
T = np.linspace(0.1, 0.9, 7)


def test_a_line_on_a_cylinder_is_a_helix():
    along = Line(np.zeros(2), np.array([0.6, 0.8]))
    c, d, d2 = CurveOnSurface(CYLINDER, along, 1.0, 2.0).evaluate(T, 2)
    p = 1.0 + 2.0 * T
    assert c == pytest.approx(
        np.stack([2 * np.cos(0.6 * p), 2 * np.sin(0.6 * p), 0.8 * p], axis=1), abs=1e-14
    )
    assert np.linalg.norm(d, axis=1) == pytest.approx(2.0 * np.hypot(2 * 0.6, 0.8))
    curvature = np.linalg.norm(np.cross(d, d2), axis=1) / np.linalg.norm(d, axis=1) ** 3
    assert curvature == pytest.approx(2 * 0.36 / (4 * 0.36 + 0.64))  # a w^2 / (a^2 w^2 + b^2)


def test_derivatives_agree_with_differences():
    torus = Torus(np.zeros(3), X, Y, Z, radius=3.0, tube=1.0, domain=((0.0, 6.0), (0.0, 6.0)))
    circle = Circle(np.array([2.0, 2.0]), X[:2], Y[:2], 1.0)
    curve = pickle.loads(pickle.dumps(CurveOnSurface(torus, circle, 0.3, -1.5)))
    step = 1e-5
    before, here, after = (curve.evaluate(T + s, 2) for s in (-step, 0.0, step))
    for order in (0, 1):
        slope = (after[order] - before[order]) / (2.0 * step)
        assert here[order + 1] == pytest.approx(slope, rel=1e-7, abs=1e-7)


def test_segments_are_as_near_as_is_proved():
    """Lines and circles of (u, v) on a cylinder and a torus, against points between."""
    torus = Torus(np.zeros(3), X, Y, Z, radius=3.0, tube=1.0, domain=((0.0, 6.0), (0.0, 6.0)))
    circle = Circle(np.array([2.0, 2.0]), X[:2], Y[:2], 1.0)
    line = Line(np.array([1.0, 1.0]), np.array([0.8, 0.6]))
    for surface in (CYLINDER, torus):
        for pcurve in (circle, line):
            curve = CurveOnSurface(surface, pcurve, 0.3, 1.0)
            ends = np.linspace(0.0, 1.0, 30)
            t = np.stack([ends[:-1], ends[1:]], axis=1)
            between = np.linspace(0.0, 1.0, 65)
            at = (1.0 - between) * t[:, :1] + between * t[:, 1:]
            points = curve.evaluate(at.ravel(), 0)[0].reshape(*at.shape, 3)
            side = points[:, -1] - points[:, 0]
            away = points - points[:, :1]
            along = np.einsum("kqc,kc->kq", away, side) / np.einsum("kc,kc->k", side, side)[:, None]
            far = np.linalg.norm(away - along[:, :, None] * side[:, None], axis=2).max(axis=1)
            bound = curve_bounds(curve.core, t, np.ascontiguousarray(points[:, (0, -1)]))
            assert (far <= bound).all() and (bound <= 1.15 * far + 1e-9).all()
