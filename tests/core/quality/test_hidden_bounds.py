"""Triangles over which nothing hides: the core against its slow twin, and against its promise."""

import naive.hidden_bounds as slow
import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.quality import hidden_bounds
from surfmesh.quality.measures.hidden_search import Pieces


def triangles_on(name, seed, count=300):
    """Triangles of many sizes and shapes in (u, v), with what their own planes are."""
    surface, draw = sm.load(name), np.random.default_rng(seed)
    low, high = np.array(surface.domain).T
    size = 10.0 ** draw.uniform(-3.0, -0.5, (count, 1, 1)) * (high - low)
    middle = low + draw.uniform(0.2, 0.8, (count, 1, 2)) * (high - low)
    uv = middle + size * draw.uniform(-0.5, 0.5, (count, 3, 2)) * [1.0, draw.choice([1.0, 0.01])]
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1)
    some = length > 1e-12
    sides = np.linalg.norm(corners[some] - corners[some][:, [1, 2, 0]], axis=2).max(axis=1)
    tolerance = sides * 10.0 ** draw.uniform(-3.0, 0.0, len(sides))
    return surface, uv[some], corners[some, 0], normal[some] / length[some, None], tolerance


@pytest.mark.parametrize("name", ["torus", "wavy", "two_peaks", "bad_speed", "cone"])
@pytest.mark.parametrize("seed", range(3))
def test_bounds_are_those_of_the_twin(name, seed):
    surface, uv, corner, normal, tolerance = triangles_on(name, seed)
    seen = 0.3 * tolerance
    found = hidden_bounds(surface.core, uv, corner, normal, tolerance, seen, slow.LEVELS)
    pieces = Pieces.of(uv, corner, normal[:, None], tolerance)
    at_once = slow.bounded_at_once(surface, pieces, seen)
    in_parts = slow.bounded_in_parts(surface, pieces)
    assert ((found == 2) == at_once).all()
    assert ((found == 1) == (in_parts & ~at_once)).all()
    assert len(set(found.tolist())) > 1


def test_what_is_bounded_is_within_the_tolerance():
    surface, uv, corner, normal, tolerance = triangles_on("wavy", 7)
    found = hidden_bounds(surface.core, uv, corner, normal, tolerance, np.zeros(len(uv)), 3)
    weights = np.random.default_rng(0).dirichlet(np.ones(3), 200)
    for k in np.flatnonzero(found == 1):
        points = surface.evaluate(weights @ uv[k], 0)[0]
        assert np.abs((points - corner[k]) @ normal[k]).max() <= tolerance[k] * (1 + 1e-9)


def test_without_bounds_nothing_is_bounded():
    class Plain:
        domain = (0.0, 1.0), (0.0, 1.0)

        def evaluate(self, uv, order):
            return tuple(np.zeros((len(uv), 3)) for _ in range((order + 1) * (order + 2) // 2))

    from surfmesh.geometry.core_surface import as_core_surface

    one = np.ones(1)
    given = np.eye(3)[None, :, :2].copy(), np.zeros((1, 3)), np.eye(3)[2:], one, one
    assert hidden_bounds(as_core_surface(Plain()), *given, 3).tolist() == [0]
    for wrong in (one[:0], np.ones(2)):
        with pytest.raises(ValueError):
            hidden_bounds(as_core_surface(Plain()), *given[:-1], wrong, 3)
    with pytest.raises(ValueError):
        hidden_bounds(as_core_surface(Plain()), *given, 99)


@pytest.mark.parametrize("name", ["torus", "wavy"])
def test_neighbours_looked_at_together_are_bounded_as_one_by_one(name):
    mesh = sm.mesh(sm.load(name), sm.Sizing(chord=0.02))
    corners = mesh.points[mesh.triangles]
    uv = mesh.parametrisation.uv_points[mesh.parametrisation.uv_triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    tolerance = np.full(len(uv), 0.026) * np.random.default_rng(0).choice([1.0, 0.3], len(uv))
    seen = 0.3 * tolerance
    corner = corners[:, 0].copy()
    found = hidden_bounds(mesh.surfaces[0].core, uv, corner, normal, tolerance, seen, 3)
    pieces = Pieces.of(uv, corner, normal[:, None], tolerance)
    at_once = slow.bounded_at_once(mesh.surfaces[0], pieces, seen)
    assert ((found == 2) == at_once).all()
    assert at_once.any() and not at_once.all()
