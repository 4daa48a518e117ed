"""Local sizes: their laws, what they refuse, and that small ones are not missed."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import surfmesh as sm
from surfmesh.errors import SizingError
from surfmesh.sizing.options.sources import reaching, source_sizes
from surfmesh.sizing.rules.across_gaps import ROW, size_across

COORDINATE = st.floats(-10.0, 10.0, width=16, allow_subnormal=False)
SOURCES = {
    "point": sm.Near([1.0, 2.0, 3.0], size=0.1),
    "points": sm.Near([[0, 0, 0], [1, 1, 1]], size=0.1, radius=0.5),
    "line": sm.Near([np.array([[0, 0, 0], [1, 0, 0], [1, 4, 0]])], size=0.2, growth=1.5),
    "flat": sm.Near([[0, 0], [1, 1]], size=0.2, lines=True),
    "ball": sm.InBall((1, 2, 3), radius=2.0, size=0.3),
    "box": sm.InBox((0, 0, 0), (1, 2, 3), size=0.3, growth=1.1),
    "cloud": sm.SizeCloud([[0, 0, 0], [5, 0, 0]], [0.1, 1.0]),
}

REFUSED = {
    "size": (lambda: sm.Near([0, 0, 0], size=0), "size must be a positive number, not 0"),
    "growth": (lambda: sm.Near([0, 0, 0], size=1, growth=1), "growth must be above 1"),
    "radius": (lambda: sm.Near([0, 0, 0], size=1, radius=-1), "radius must be a number from 0"),
    "empty": (lambda: sm.Near([], size=1), "empty"),
    "ball": (lambda: sm.InBall((0, 0), 1, 1), "centre must be three finite numbers"),
    "box": (lambda: sm.InBox((1, 0, 0), (0, 1, 1), 1), "inside out"),
    "cloud": (lambda: sm.SizeCloud([[0, 0, 0]], [1, 2]), r"points \(n, 3\) and sizes \(n,\)"),
    "sizes": (lambda: sm.SizeCloud([[0, 0, 0]], [-1]), "sizes positive"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    make, message = REFUSED[case]
    with pytest.raises(SizingError, match=message):
        make()


@pytest.mark.parametrize("name", SOURCES)
def test_smallest_at_its_marks_and_by_itself_in_a_pickle(name):
    source = SOURCES[name]
    assert source(source.marks).min() == pytest.approx(source.size)
    again = pickle.loads(pickle.dumps(source))
    places = np.random.default_rng(0).normal(scale=3.0, size=(50, 3))
    assert np.array_equal(again(places), source(places))
    assert repr(source).endswith(")") and len(repr(source)) < 80


@pytest.mark.parametrize("name", SOURCES)
@given(ends=arrays(float, (2, 3), elements=COORDINATE))
def test_slope_is_kept(name, ends):
    source = SOURCES[name]
    a, b = source(ends)
    assert abs(a - b) <= source.slope * np.linalg.norm(ends[1] - ends[0]) + 1e-9


@pytest.mark.parametrize("name", SOURCES)
@given(point=arrays(float, (1, 3), elements=COORDINATE), largest=st.floats(0.05, 2.0))
def test_nothing_smaller_outside_its_box(name, point, largest):
    source = SOURCES[name]
    low, high = source.box(largest)
    if ((point < low) | (point > high)).any():
        assert source(point)[0] >= largest - 1e-12
        assert reaching((source,), point[0], point[0], largest) == ()


def test_law_of_a_ball():
    ball = sm.InBall((0, 0, 0), radius=1.0, size=0.5, growth=1.5, reach=3.0)
    places = np.array([[0.5, 0, 0], [1, 0, 0], [2, 0, 0], [3.5, 0, 0]])
    assert ball(places) == pytest.approx([0.5, 0.5, 0.5 + 0.4, np.inf])


def test_smallest_source_wins_and_must_give_sizes():
    places = np.zeros((3, 3))
    found = source_sizes((SOURCES["cloud"], lambda p: np.full(len(p), 0.05)), places)
    assert found == pytest.approx(0.05)
    with pytest.raises(SizingError, match=r"source law must give positive numbers of shape \(3,\)"):
        source_sizes((lambda p: 1.0,), places)


def test_cloud_of_many_sizes_is_the_graded_minimum():
    rng = np.random.default_rng(1)
    points, sizes = rng.uniform(size=(200, 3)), 10.0 ** rng.uniform(-4, 0, 200)
    cloud = sm.SizeCloud(points, sizes)
    places = rng.uniform(size=(100, 3))
    away = np.linalg.norm(places[:, None] - points, axis=2)
    exact = (sizes + cloud.slope * away).min(axis=1)
    assert (cloud(places) >= exact - 1e-15).all()
    assert cloud(places) == pytest.approx(exact, rel=0.02)


def test_cloud_of_a_mesh():
    mesh = sm.mesh(sm.load("sphere"), 0.3)
    cloud = sm.SizeCloud.of_mesh(mesh, factor=0.5)
    assert cloud(mesh.points).mean() == pytest.approx(0.15, rel=0.1)
    trimesh = sm.SizeCloud.of_mesh(mesh.to_trimesh(), factor=0.5)
    assert trimesh.sizes.sum() == pytest.approx(cloud.sizes.sum())


@given(count=st.floats(0.5, 20), growth=st.floats(1.01, 3.0))
def test_rows_across_a_gap(count, growth):
    slope = 2.0 * (growth - 1.0) / (growth + 1.0)
    h = size_across(1.0, count, slope)
    x = np.linspace(0.0, 0.5, 2001)
    rows = 2.0 * np.trapezoid(1.0 / (ROW * (h + slope * x)), x)
    assert rows >= count * (1.0 - 1e-6)
    assert h <= 1.0 / count


@pytest.mark.parametrize("name", ["plane", "two_peaks"])
def test_a_small_source_within_a_surface_is_seen(name):
    surface = sm.load(name)
    (u0, u1), (v0, v1) = surface.domain
    at = np.array([[u0 + 0.4137 * (u1 - u0), v0 + 0.3391 * (v1 - v0)]])
    (place,) = surface.evaluate(at, 0)
    extent = u1 - u0
    sizing = sm.Sizing(size=0.05 * extent, sources=sm.Near(place, size=1e-4 * extent))
    mesh = sm.mesh(surface, sizing)
    away = np.linalg.norm(mesh.points - place, axis=1)
    assert mesh.sizes[away.argmin()] < 2e-4 * extent
    assert sm.check(mesh).clean


def test_callables_are_asked_for_arrays():
    asked = []

    def law(points):
        asked.append(len(points))
        return np.full(len(points), 0.2)

    sm.mesh(sm.load("plane"), sm.Sizing(size=0.5, sources=law))
    assert len(asked) < 100 and np.mean(asked) > 20
