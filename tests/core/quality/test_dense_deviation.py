"""A closer look at triangles, against the search for nearest points surface by surface."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.quality import dense_deviation
from surfmesh.accuracy.deviation import STEPS, nearest_deviations
from surfmesh.accuracy.samples import DENSE
from surfmesh.quality.measures.known_surfaces import KnownSurfaces


@pytest.fixture(scope="module")
def known():
    found = KnownSurfaces.of(sm.mesh(sm.load("torus"), sm.Sizing(chord=0.05)))
    assert found is not None
    return found


def test_it_finds_what_a_search_from_each_point_finds(known):
    mesh = known.mesh
    chosen = np.arange(0, len(mesh.triangles), 7, dtype=np.int32)
    largest, triangle, point, uv = dense_deviation(*known.arrays, chosen, DENSE, 0.05, STEPS)
    rows = np.repeat(np.arange(len(chosen)), len(DENSE))
    rule = np.tile(np.arange(len(DENSE), dtype=np.int32), len(chosen))
    places, guesses = known.samples(chosen[rows], rule, DENSE)
    feet, distance = nearest_deviations(
        mesh.surfaces[0], places, guesses, known.uv(chosen), rows, 0.05, STEPS
    )
    np.testing.assert_array_equal(largest, distance.reshape(len(chosen), -1).max(axis=1))
    worst = int(distance.argmax())
    assert triangle == chosen[rows[worst]]
    np.testing.assert_array_equal(point, places[worst])
    np.testing.assert_array_equal(uv, feet[worst])


def test_triangles_must_be_those_of_the_mesh(known):
    beyond = np.array([len(known.mesh.triangles)], np.int32)
    with pytest.raises(ValueError, match="out of range"):
        dense_deviation(*known.arrays, beyond, DENSE, 0.05, STEPS)


@pytest.mark.parametrize("size", [0.7, 3.0])  # the larger one gives a rim of four sides
def test_on_a_cylinder_it_finds_what_a_search_finds(size):
    part = pytest.importorskip("cadquery").Workplane().circle(2.0).extrude(3.0)
    known = KnownSurfaces.of(sm.mesh(part, sm.Sizing(size=size)))
    mesh = known.mesh
    turn = max(np.ptp(known.uv(np.array([t]))[0, :, 0]) for t in range(len(mesh.triangles)))
    assert (turn > 1.5) == (size > 1.0)
    chosen = np.arange(len(mesh.triangles), dtype=np.int32)
    largest, triangle, point, uv = dense_deviation(*known.arrays, chosen, DENSE, 0.05, STEPS)
    for face, surface in enumerate(mesh.surfaces):
        here = chosen[mesh.face_ids == face]
        rows = np.repeat(np.arange(len(here)), len(DENSE))
        rule = np.tile(np.arange(len(DENSE), dtype=np.int32), len(here))
        places, guesses = known.samples(here[rows], rule, DENSE)
        _, distance = nearest_deviations(
            surface, places, guesses, known.uv(here), rows, 0.05, STEPS
        )
        expected = distance.reshape(len(here), -1).max(axis=1)
        np.testing.assert_allclose(largest[here], expected, rtol=1e-6, atol=1e-15)
    assert largest[triangle] == largest.max() > 0.01
    face = mesh.face_ids[triangle]
    foot = mesh.surfaces[face].evaluate(np.array([uv]), 0)[0][0]
    assert np.linalg.norm(foot - point) == pytest.approx(largest[triangle], rel=1e-6)


def test_a_corner_off_a_cylinder_is_searched_for():
    part = pytest.importorskip("cadquery").Workplane().circle(2.0).extrude(3.0)
    mesh = sm.mesh(part, sm.Sizing(size=0.7))
    round_face = next(k for k in range(3) if mesh.groups.face_kind(k) == "cylinder")
    chosen = np.flatnonzero(mesh.face_ids == round_face).astype(np.int32)
    uv = mesh.uv_points.copy()
    corner = mesh.uv_triangles[chosen[0], 0]
    uv[corner, 1] += 40.0  # far beyond the end of the cylinder
    wrong = KnownSurfaces.of(mesh.replaced(uv_points=uv))
    largest, *_ = dense_deviation(*wrong.arrays, chosen[:1], DENSE, 0.05, STEPS)
    assert largest[0] >= 0.0 and np.isfinite(largest).all()
    points = mesh.points.copy()
    points[mesh.triangles[chosen[0], 0]] *= 1.5
    off = KnownSurfaces.of(mesh.replaced(points=points))
    largest, *_ = dense_deviation(*off.arrays, chosen[:1], DENSE, 0.05, STEPS)
    assert largest[0] > 0.5
