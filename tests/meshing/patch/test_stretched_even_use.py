"""``Sizing(fewest=True)`` with ``anisotropy``: triangles share the chord evenly, and are few."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm


def stretched(surface, chord, **options):
    return sm.mesh(surface, chord=chord, anisotropy=100.0, jobs=1, **options)


def require_kept(mesh, chord):
    report = sm.check(mesh)
    assert report.clean, report.problems
    assert report.deviation_two_sided <= chord
    assert report.above_growth_share < 0.01
    return report


@pytest.mark.parametrize(
    "name, chord, most",
    [
        ("sphere", 2e-3, 1.3),  # over the least that any triangles need
        ("bad_speed", 2e-3, 1.3),
        ("torus", 2e-3, 1.45),
        ("catenoid", 4e-4, 1.55),  # a lattice; of random directions 1.7
    ],
)
def test_few_more_than_the_least_are_needed(name, chord, most):
    surface = sm.load(name)
    few, usual = stretched(surface, chord, fewest=True), stretched(surface, chord)
    report = require_kept(few, chord)
    assert len(few.triangles) < 0.9 * len(usual.triangles)
    assert len(few.triangles) < most * report.least_triangles


def test_most_triangles_use_as_much_of_the_chord():
    few = stretched(sm.load("sphere"), 1e-3, fewest=True)
    corners = few.points[few.triangles]
    height = np.linalg.norm(corners.mean(axis=1), axis=1)  # of a sphere of radius 1, the centroid
    used = (np.linalg.norm(few.points, axis=1).mean() - height) / 1e-3
    low, high = np.quantile(used, [0.1, 0.9])
    assert 0.75 < low < high < 0.97


@settings(max_examples=6, deadline=None)
@given(st.floats(0.4, 1.0), st.floats(1.0, 2.5))
def test_the_chord_is_kept_on_ellipsoids(short, long):
    surface = sm.ParametricSurface(
        f"{long}*cos(u)*sin(v)", "sin(u)*sin(v)", f"{short}*cos(v)",
        u=(0.0, 2.0 * np.pi), v=(0.0, np.pi),
    )  # fmt: skip
    few = stretched(surface, 4e-3, fewest=True)
    require_kept(few, 4e-3)
    assert len(few.triangles) <= len(stretched(surface, 4e-3).triangles)


def test_proved_and_by_any_number_of_workers():
    surface = sm.load("torus")
    options = {"chord": 0.01, "anisotropy": 100.0, "fewest": True, "proof": True}
    one, two = (sm.mesh(surface, jobs=jobs, **options) for jobs in (1, 2))
    assert np.array_equal(one.points, two.points)
    assert np.array_equal(one.triangles, two.triangles)
    assert require_kept(one, 0.01).proof.proved_share == 1.0


@pytest.mark.parametrize("other", [{"angle": 12.0}, {"vertices": "balanced"}])
def test_an_angle_and_balanced_vertices_leave_meshes_as_they_are(other):
    surface = sm.load("torus")
    few, usual = (stretched(surface, 0.01, fewest=few, **other) for few in (True, False))
    assert np.array_equal(few.points, usual.points)
    assert np.array_equal(few.triangles, usual.triangles)


def test_faces_of_models_too():
    cadquery = pytest.importorskip("cadquery")
    loft = cadquery.Workplane().rect(4, 3).workplane(offset=4).circle(1.5).loft()
    few, usual = (stretched(loft, 0.005, fewest=few) for few in (True, False))
    require_kept(few, 0.005)
    assert len(few.triangles) < 0.95 * len(usual.triangles)
