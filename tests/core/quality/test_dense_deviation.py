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
