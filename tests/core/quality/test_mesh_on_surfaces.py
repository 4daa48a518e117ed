"""Samples, creases and volumes of a mesh on its surfaces: against what they stand for."""

import numpy as np
import pytest
from naive.triangle_distances import triangle_distances

import surfmesh as sm
from surfmesh._core.quality import (
    enclosed_volumes,
    face_creases,
    far_corners,
    sampled_surface,
    surface_distances,
)

WEIGHTS = np.array([(0.5, 0.25, 0.25), (1.0, 0.0, 0.0)])


@pytest.fixture(scope="module")
def torus():
    return sm.mesh(sm.load("torus"), sm.Sizing(size=0.5))


def arrays(mesh):
    known = mesh.parametrisation
    return {
        "surfaces": [surface.core for surface in mesh.surfaces], "points": mesh.points,
        "triangles": mesh.triangles, "uv": known.uv_points,
        "uv_triangles": known.uv_triangles, "faces": mesh.face_ids,
    }  # fmt: skip


def test_samples_are_points_of_the_surface_and_their_distances(torus):
    triangle = np.arange(0, len(torus.triangles), 7, dtype=np.int32)
    rule = (np.arange(len(triangle)) % 2).astype(np.int32)
    uv, points, distance = sampled_surface(
        **arrays(torus), triangle=triangle, rule=rule, weights=WEIGHTS
    )
    known = torus.parametrisation
    corners = known.uv_points[known.uv_triangles[triangle]]
    assert uv == pytest.approx(np.einsum("kij,ki->kj", corners, WEIGHTS[rule]), abs=1e-14)
    assert (points == torus.surfaces[0].evaluate(uv, 0)[0]).all()
    slow = triangle_distances(points, torus.points[torus.triangles[triangle]])
    assert distance == pytest.approx(slow, abs=1e-12)
    assert distance[rule == 1].max() < 1e-12 < 1e-4 < distance[rule == 0].max()


def test_distances_over_triangles_are_those_of_samples(torus):
    some = np.arange(len(torus.triangles), dtype=np.int32)[::-2]
    triangle, rule = some.repeat(2), np.tile(np.arange(2, dtype=np.int32), len(some))
    _, _, expected = sampled_surface(**arrays(torus), triangle=triangle, rule=rule, weights=WEIGHTS)
    found = surface_distances(**arrays(torus), triangle=some, weights=WEIGHTS)
    assert (found == expected).all()


def test_far_corners_are_those_of_places_whose_vertices_have_moved(torus):
    points = torus.points.copy()
    moved = np.array([3, 40, 41])
    points[moved] += 0.01
    none = np.zeros(len(torus.triangles), np.uint8)
    given = arrays(torus) | {"points": points, "limit": 1e-6}
    found = far_corners(**given, left_out=none)
    assert set(torus.triangles.ravel()[found]) == set(moved)
    places = torus.parametrisation.uv_triangles.ravel()
    of_moved = np.unique(places[np.isin(torus.triangles, moved).ravel()])
    assert places[found].tolist() == of_moved.tolist()  # one corner each
    beside = np.isin(torus.triangles, moved).any(axis=1)
    assert len(far_corners(**given, left_out=beside.view(np.uint8))) == 0
    assert len(far_corners(**given | {"limit": 0.1}, left_out=none)) == 0
    with pytest.raises(ValueError, match="left_out"):
        far_corners(**given, left_out=none[1:])


def test_a_torus_has_no_crease_where_triangles_turn(torus):
    pairs = torus.connectivity.half_edges
    assert not face_creases(**arrays(torus), edges=pairs, angle=np.array([1.0])).any()
    # where a degree asks for less than the finest size all of it is bent
    assert face_creases(**arrays(torus), edges=pairs, angle=np.array([1e-3])).all()


def test_volumes_of_boxes_far_away():
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    box = np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))], np.int32)
    points = np.concatenate([corners + 1e6, 2.0 * corners - 1e6])
    triangles = np.concatenate([box, box[:, ::-1] + 8])
    solid = np.repeat(np.arange(2, dtype=np.int32), 12)
    found = enclosed_volumes(points, triangles, solid, points[[0, 8]])
    assert found == pytest.approx([1.0, -8.0], rel=1e-14)


def test_what_is_out_of_range_is_refused(torus):
    right = arrays(torus)
    triangle, pairs = np.zeros(1, np.int32), torus.connectivity.half_edges
    for name in ("triangles", "uv_triangles", "faces"):
        wrong = {**right, name: right[name] + 100_000}
        with pytest.raises(ValueError):
            sampled_surface(**wrong, triangle=triangle, rule=triangle, weights=WEIGHTS)
        with pytest.raises(ValueError):
            face_creases(**wrong, edges=pairs, angle=np.ones(1))
        with pytest.raises(ValueError):
            surface_distances(**wrong, triangle=np.zeros(1, np.int32), weights=WEIGHTS)
    for bad in (-1, len(right["triangles"])):
        with pytest.raises(ValueError):
            sampled_surface(**right, triangle=triangle + bad, rule=triangle, weights=WEIGHTS)
    with pytest.raises(ValueError):
        sampled_surface(**right, triangle=triangle, rule=triangle + 2, weights=WEIGHTS)
    with pytest.raises(ValueError):
        face_creases(**right, edges=pairs, angle=np.ones(2))
    with pytest.raises(ValueError):
        face_creases(**right, edges=pairs - 1, angle=np.ones(1))
    with pytest.raises(ValueError):
        enclosed_volumes(right["points"], right["triangles"], right["faces"] + 1, np.zeros((1, 3)))
