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
    pieces = Pieces.of(
        uv[some], corners[some, 0], normal[some, None] / length[some, None, None], tolerance
    )
    return surface, corners[some], pieces


def bounded_by_core(surface, corners, pieces, seen, whole=False, levels=slow.LEVELS):
    """Of triangles that share no corner."""
    rows = np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3)
    return hidden_bounds(
        surface.core, corners.reshape(-1, 3), rows, pieces.uv.reshape(-1, 2), rows,
        np.arange(len(rows), dtype=np.int32), pieces.tolerance, seen,
        np.full(len(rows), whole, np.uint8), levels,
    )  # fmt: skip


@pytest.mark.parametrize("name", ["torus", "wavy", "two_peaks", "bad_speed", "cone"])
@pytest.mark.parametrize("seed", range(3))
def test_bounds_are_those_of_the_twin(name, seed):
    surface, corners, pieces = triangles_on(name, seed)
    seen = 0.3 * pieces.tolerance
    at_once = slow.bounded_at_once(surface, pieces, seen)
    between = slow.bounded_between_samples(surface, pieces, seen)
    in_parts = slow.bounded_in_parts(surface, pieces)
    expected = at_once | between | in_parts
    assert (bounded_by_core(surface, corners, pieces, seen) == expected).all()
    assert (bounded_by_core(surface, corners, pieces, seen, whole=True) == at_once).all()
    assert len(set(expected.tolist())) > 1


def test_what_is_bounded_is_within_the_tolerance():
    surface, corners, pieces = triangles_on("wavy", 7)
    bounds = pieces.tolerance.copy()
    weights = np.random.default_rng(0).dirichlet(np.ones(3), 200)
    samples = np.array([(3, 0, 0), (0, 3, 0), (0, 0, 3), (1.5, 1.5, 0), (0, 1.5, 1.5),
                        (1.5, 0, 1.5), (1, 1, 1)]) / 3.0  # fmt: skip

    def farthest(k, places):
        points = surface.evaluate(places @ pieces.uv[k], 0)[0]
        return np.abs((points - pieces.corner[k]) @ pieces.normal[k, 0]).max()

    seen = np.array([farthest(k, samples) for k in range(len(corners))])
    found = bounded_by_core(surface, corners, pieces, seen)
    assert 0 < np.count_nonzero(found) < len(found)
    for k in np.flatnonzero(found):
        assert farthest(k, weights) <= bounds[k] * (1 + 1e-9)


def test_without_area_nothing_hides():
    surface, corners, pieces = triangles_on("wavy", 1, count=3)
    corners[0] = corners[0, 0]
    pieces.tolerance[:] = 0.0
    found = bounded_by_core(surface, corners, pieces, np.ones(len(corners)))
    assert found.tolist() == [1, *[0] * (len(corners) - 1)]


def test_without_bounds_nothing_is_bounded():
    class Plain:
        domain = (0.0, 1.0), (0.0, 1.0)

        def evaluate(self, uv, order):
            return tuple(np.zeros((len(uv), 3)) for _ in range((order + 1) * (order + 2) // 2))

    from surfmesh.geometry.core_surface import as_core_surface

    surface, one, row = as_core_surface(Plain()), np.ones(1), np.zeros(1, np.int32)
    corners = np.arange(3, dtype=np.int32)[None]
    mesh = np.eye(3), corners, np.eye(3)[:, :2].copy(), corners
    none = np.zeros(1, np.uint8)
    assert hidden_bounds(surface, *mesh, row, one, one, none, 3).tolist() == [0]
    for wrong in (one[:0], np.ones(2)):
        with pytest.raises(ValueError):
            hidden_bounds(surface, *mesh, row, one, wrong, none, 3)
    with pytest.raises(ValueError):
        hidden_bounds(surface, *mesh, row, one, one, none, 99)
    with pytest.raises(ValueError):
        hidden_bounds(surface, *mesh, row + 1, one, one, none, 3)


def triangles_of_mesh(name, chord, fraction=0.3):
    """Those of a mesh with a tolerance each, what its samples might have seen, and its surface."""
    mesh = sm.mesh(sm.load(name), sm.Sizing(chord=chord))
    corners = mesh.points[mesh.triangles]
    uv = mesh.parametrisation.uv_points[mesh.parametrisation.uv_triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    draw = np.random.default_rng(0)
    tolerance = np.full(len(uv), 1.3 * chord) * draw.choice([1.0, 0.3], len(uv))
    pieces = Pieces.of(uv, corners[:, 0], normal[:, None], tolerance)
    return mesh.surfaces[0], corners, pieces, fraction * tolerance


@pytest.mark.parametrize("name", ["torus", "wavy"])
def test_neighbours_looked_at_together_are_bounded_as_one_by_one(name):
    surface, corners, pieces, seen = triangles_of_mesh(name, 0.02)
    at_once = slow.bounded_at_once(surface, pieces, seen)
    assert (bounded_by_core(surface, corners, pieces, seen, whole=True) == at_once).all()
    assert at_once.any() and not at_once.all()
    expected = at_once | slow.bounded_between_samples(surface, pieces, seen)
    expected |= slow.bounded_in_parts(surface, pieces)
    assert (bounded_by_core(surface, corners, pieces, seen) == expected).all()


def test_models_of_neighbours_bound_more_and_nothing_too_closely():
    """Formulas that read u and v often: Taylor's formula around some triangles bounds what
    intervals leave, and the surface does bend as little there."""
    surface, corners, pieces, seen = triangles_of_mesh("two_peaks", 0.005, 0.8)
    expected = slow.bounded_at_once(surface, pieces, seen)
    expected |= slow.bounded_between_samples(surface, pieces, seen)
    found = bounded_by_core(surface, corners, pieces, seen, levels=0).astype(bool)
    more = np.flatnonzero(found & ~expected)
    assert (found >= expected).all() and len(more) > 20
    weights = np.random.default_rng(0).dirichlet(np.ones(3), 50)
    uv = np.einsum("wk,nki->nwi", weights, pieces.uv[more])
    points = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(len(more), -1, 3)
    flat = np.einsum("wk,nki->nwi", weights, corners[more])
    error = np.abs(np.einsum("nwi,ni->nw", points - flat, pieces.normal[more, 0])).max(axis=1)
    limit = np.maximum(4.0 * (pieces.tolerance - seen), pieces.tolerance)[more]
    assert (error <= limit * (1 + 1e-9)).all()
