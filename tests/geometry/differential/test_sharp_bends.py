"""Where a surface bends with less than a radius: values from the curves they are drawn from."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.geometry.differential.sharp_bends import bends_sharply


def triangles_at(u: float, v: float, size: float) -> np.ndarray:
    """One triangle around (u, v)."""
    angles = np.array([0.3, 0.3 + 2.0 * np.pi / 3.0, 0.3 + 4.0 * np.pi / 3.0])
    return (np.array([u, v]) + size * np.stack([np.cos(angles), np.sin(angles)], axis=1))[None]


@pytest.fixture(scope="module")
def cylinder():
    return sm.ParametricSurface("2*cos(u)", "2*sin(u)", "v", u=(0, 3), v=(0, 3))


@pytest.fixture(scope="module")
def cusp():
    return sm.ParametricSurface("u**2", "u**3", "v", u=(-1, 1), v=(-1, 1))


def test_a_cylinder_bends_with_its_radius(cylinder):
    for size in (1e-3, 0.1, 1.0):
        corners = triangles_at(1.5, 1.5, size)
        assert not bends_sharply(cylinder, corners, 1.99)[0]
        assert bends_sharply(cylinder, corners, 2.01)[0]


def test_a_plane_does_not_bend():
    plane = sm.ParametricSurface("u", "v", "0*u", u=(0, 1), v=(0, 1))
    assert not bends_sharply(plane, triangles_at(0.5, 0.5, 0.3), 1e9).any()


@pytest.mark.parametrize("size", [1e-3, 0.3])
@pytest.mark.parametrize("radius", [1e-6, 0.1])
def test_at_a_cusp_the_normal_turns_over_at_any_size(cusp, size, radius):
    """(t^2, t^3): the radius of curvature is t (4 + 9 t^2)^(3/2) / 6."""
    around, beside = triangles_at(0.01 * size, 0.0, size), triangles_at(0.95, 0.0, 0.04)
    found = bends_sharply(cusp, np.concatenate([around, beside]), radius)
    assert found.tolist() == [True, False]


def test_a_tube_that_is_pulled_through_itself_turns_inside_out():
    tube = sm.ParametricSurface("u*cos(v)", "u*sin(v)", "3*u", u=(-1, 1), v=(0, 6))
    corners = np.concatenate([triangles_at(0.02, 3.0, 0.1), triangles_at(0.7, 3.0, 0.1)])
    assert bends_sharply(tube, corners, 1e-4).tolist() == [True, False]


def test_no_triangles(cylinder):
    assert bends_sharply(cylinder, np.empty((0, 3, 2)), 1.0).shape == (0,)
