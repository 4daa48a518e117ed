"""Deviation, normals and dihedral angles of plain triangles, where they are known exactly."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.patch import (
    dense_samples,
    point_deviations,
    triangle_deviations,
    vertex_deviations,
)
from surfmesh.accuracy.folds import cosines_with_surface
from surfmesh.accuracy.samples import DENSE
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.chart import Chart

SPHERE = sm.load("sphere")


def on_sphere(count=200, seed=1):
    (u0, u1), (v0, v1) = SPHERE.domain
    t = np.random.default_rng(seed).uniform(0.2, 0.8, (count, 2))
    return np.array([u0, v0]) + t * np.array([u1 - u0, v1 - v0])


def triangles_on_sphere(size=0.05):
    """Parameters (n, 3, 2) of small triangles, counter-clockwise in (u, v)."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 0.9]])
    return on_sphere()[:, None] + size * corners


def test_samples_are_barycentric_and_hold_the_corners():
    assert DENSE.sum(axis=1) == pytest.approx(1.0)
    inner = DENSE[DENSE.max(axis=1) < 1.0]  # in the mesher the corners lie on the surface
    assert (inner == dense_samples()).all() and len(DENSE) == len(inner) + 3


def test_points_at_a_distance():
    uv = on_sphere()
    (r,) = SPHERE.evaluate(uv, 0)
    radius = np.linalg.norm(r, axis=1)
    size = np.full(len(uv), 0.1)
    assert vertex_deviations(SPHERE.core, r, uv, size).max() == 0.0
    for factor in (0.9, 1.02):
        away = np.abs(factor - 1.0) * radius
        # feet are far enough off to be looked for
        found, normals = point_deviations(SPHERE.core, factor * r, uv + 0.01, size)
        assert found == pytest.approx(away, rel=1e-3)
        assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0)


def test_triangles_lie_below_the_sphere_by_their_sagitta():
    uv = triangles_on_sphere()
    chart = Chart.of(SPHERE)
    xy = chart.to_plane(uv.reshape(-1, 2)).reshape(uv.shape)
    corners = SPHERE.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    height = np.einsum("ij,ij->i", normal, corners[:, 0]) / np.linalg.norm(normal, axis=1)
    radius = np.linalg.norm(corners[0, 0])
    found = triangle_deviations(
        as_core_surface(SPHERE), chart.core, corners, xy, 1e-9
    )  # all are looked at closely
    assert (found <= radius - np.abs(height) + 1e-12).all()
    assert (found > 0.8 * (radius - np.abs(height))).all()


def test_cosines_know_which_side_is_up():
    uv = triangles_on_sphere()
    corners = SPHERE.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    assert cosines_with_surface(SPHERE, corners, uv.mean(axis=1)).min() > 0.99
    turned = corners[:, ::-1]
    assert cosines_with_surface(SPHERE, turned, uv.mean(axis=1)).max() < -0.99
    flat = np.repeat(corners[:, :1], 3, axis=1)  # no area: no normal
    assert np.isnan(cosines_with_surface(SPHERE, flat, uv.mean(axis=1))).all()
