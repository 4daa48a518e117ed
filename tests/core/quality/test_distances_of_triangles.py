"""Distances from triangles and from those around them, points of many surfaces: slow twins."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from naive.triangle_distances import triangle_distances as slow

import surfmesh as sm
from surfmesh._core.quality import TriangleStars, mesh_deviation, surface_points
from surfmesh._core.space import triangle_distances

seeds = st.integers(0, 2**31)


@given(seeds)
def test_distances_are_those_of_the_twin(seed):
    draw = np.random.default_rng(seed)
    corners = draw.integers(-2, 3, size=(50, 3, 3)).astype(float)  # many without area
    points = draw.normal(size=(50, 3))
    assert triangle_distances(points, corners) == pytest.approx(slow(points, corners), abs=1e-12)
    found = triangle_distances(points[:1], corners)
    every = np.broadcast_to(points[0], (50, 3))
    assert found == pytest.approx(slow(every, corners), abs=1e-12)


def test_a_walk_on_a_convex_mesh_ends_at_the_nearest_triangle():
    mesh = sm.mesh(sm.load("torus"))
    stars = TriangleStars(mesh.points, mesh.triangles)
    triangle = np.arange(0, len(mesh.triangles), 50, dtype=np.int32)
    points = mesh.points[mesh.triangles[triangle]].mean(axis=1) + 1e-3
    start = np.roll(triangle, 1)
    far = stars.distances(points, start)
    corners = mesh.points[mesh.triangles]
    nearest = [slow(np.broadcast_to(point, (len(corners), 3)), corners).min() for point in points]
    assert stars.distances(points, triangle) == pytest.approx(
        slow(points, corners[triangle]), abs=1e-12
    )
    walked = stars.walk(points, triangle, stars.distances(points, triangle))
    assert walked == pytest.approx(nearest, abs=1e-12)
    assert (stars.walk(points, start, far) <= far).all()
    around = stars.distances_from_stars(points, mesh.triangles[triangle])
    assert around == pytest.approx(nearest, abs=1e-12)


def test_points_of_faces_in_any_order():
    surfaces = [sm.load(name) for name in ("torus", "two_peaks")]
    draw = np.random.default_rng(0)
    faces, uv = draw.integers(0, 2, 100).astype(np.int32), draw.random((100, 2))
    found = surface_points([surface.core for surface in surfaces], faces, uv, 1)
    for k, surface in enumerate(surfaces):
        for values, there in zip(found, surface.evaluate(uv[faces == k], 1)):
            assert (values[faces == k] == there).all()


def given_mesh(**changes):
    surface = sm.load("torus")
    mesh = sm.mesh(surface, sm.Sizing(size=1.0))
    known = mesh.parametrisation
    values = {
        "surfaces": [surface.core], "points": mesh.points, "triangles": mesh.triangles,
        "uv": known.uv_points, "uv_triangles": known.uv_triangles, "faces": mesh.face_ids,
        "edges": mesh.connectivity.half_edges, "area": np.ones(len(mesh.triangles)),
        "in_plane": np.zeros(len(mesh.triangles), np.uint8),
    }  # fmt: skip
    return {**values, **changes}


def test_what_is_out_of_range_is_refused():
    mesh_deviation(**given_mesh())
    right = given_mesh()
    for name in ("triangles", "uv_triangles", "faces", "edges"):
        with pytest.raises(ValueError):
            mesh_deviation(**{**right, name: right[name] + 100_000})
    for name in ("area", "in_plane"):
        with pytest.raises(ValueError):
            mesh_deviation(**{**right, name: right[name][1:]})
    stars = TriangleStars(right["points"], right["triangles"])
    for wrong in (-1, len(right["triangles"])):
        with pytest.raises(ValueError):
            stars.distances(right["points"][:1], np.array([wrong], np.int32))
    with pytest.raises(ValueError):
        surface_points(right["surfaces"], np.array([1], np.int32), np.zeros((1, 2)), 0)


def test_what_a_callers_surface_raises_comes_through():
    class Failing:
        domain = (0.0, 1.0), (0.0, 1.0)

        def evaluate(self, uv, order):
            raise RuntimeError("no more")

    from surfmesh.geometry.core_surface import as_core_surface

    with pytest.raises(RuntimeError, match="no more"):
        surface_points([as_core_surface(Failing())], np.zeros(1, np.int32), np.zeros((1, 2)), 0)
    with pytest.raises(RuntimeError, match="no more"):
        mesh_deviation(**given_mesh(surfaces=[as_core_surface(Failing())]))
