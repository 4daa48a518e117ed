"""Sizes by the distance to lines and points, in the plane and in space."""

import pickle

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import plane_graph

import surfmesh as sm
from surfmesh.errors import SizingError

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)

REFUSED = {
    "zero": (dict(near=0), "near must be a positive number, not 0"),
    "negative": (dict(far=-1), "far must be a positive number, not -1"),
    "nan": (dict(reach=np.nan), "reach must be a positive number, not nan"),
    "text": (dict(reach="far"), "reach must be a positive number, not 'far'"),
    "nothing": (dict(geometry=[]), "is empty"),
    "none": (dict(geometry=None), "distances are to a PlanarDomain or to arrays"),
    "word": (dict(geometry="circle"), "distances are to a PlanarDomain or to arrays"),
    "shape": (dict(geometry=[SQUARE, np.zeros((2, 4))]), r"polyline 1 has shape \(2, 4\)"),
    "infinite": (dict(geometry=[SQUARE + np.inf]), "polyline 0 has a point that is not finite"),
    "shapely": (dict(geometry=shapely.Point(0, 0)), "must be made a PlanarDomain"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    changed, reason = REFUSED[case]
    with pytest.raises(SizingError, match=reason):
        sm.DistanceSize(**(dict(geometry=SQUARE, near=1, far=2, reach=3) | changed))


def test_linear_from_near_to_far():
    law = sm.DistanceSize([[0, 0, 0], [0, 0, 5]], near=0.1, far=0.5, reach=2.0)
    points = np.array([[0, 0, 1], [1, 0, 2], [0, 2, 3], [3, 0, 0], [0, 0, 9]], float)
    assert law(points) == pytest.approx([0.1, 0.3, 0.5, 0.5, 0.5])
    shrinking = sm.DistanceSize([[0, 0]], near=2, far=1, reach=1)
    assert shrinking([[0, 0], [0.5, 0], [5, 0]]) == pytest.approx([2, 1.5, 1])


def test_to_a_domain():
    domain = sm.PlanarDomain(SQUARE, points=[(0.5, 0.5)])
    law = sm.DistanceSize(domain, 0.1, 0.2, 1.0)
    assert law([[0.5, 0.2, 0], [0.5, 0.7, 0], [0.5, 0.5, 0]]) == pytest.approx([0.12, 0.12, 0.1])
    assert sm.Sizing(size=law).size is law
    twin = pickle.loads(pickle.dumps(law))
    assert twin([[0.3, 0.2, 0]]) == law([[0.3, 0.2, 0]])


def test_points_and_polylines():
    cloud = sm.DistanceSize(np.array([[0.0, 0, 0], [4, 0, 0]])[:, None], 1, 2, 1)
    line = sm.DistanceSize(np.array([[0.0, 0, 0], [4, 0, 0]]), 1, 2, 1)
    several = sm.DistanceSize([[(0, 0)], [(4, 0), (4, 1)]], 1, 2, 1)
    middle = [[2.0, 0.0, 0.0]]
    assert (cloud.distance(middle), line.distance(middle)) == (2.0, 0.0)
    assert several.distance([[0, 3, 0], [5, 1, 0], [4, 0.5, 7]]).tolist() == [3, 1, 7]


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1), st.integers(1, 90), st.sampled_from([1e-9, 1.0, 1e9]))
def test_distances_are_exact(seed, count, factor):
    """Against the segments one by one; among them short ones and points."""
    random = np.random.default_rng(seed)
    starts = factor * random.uniform(-1, 1, (count, 3))
    lengths = factor * random.choice([0, 1e-3, 1], (count, 1))
    ends = starts + lengths * random.normal(size=(count, 3))
    law = sm.DistanceSize(np.stack([starts, ends], axis=1), factor, factor, factor)
    probes = factor * random.uniform(-2, 2, (15, 3))
    expected = np.array([plane_graph.distance(p, starts, ends) for p in probes])
    assert law.distance(probes) / factor == pytest.approx(expected / factor, abs=1e-14)
    assert law.distance(starts).max() <= 1e-15 * factor


def test_a_circle_of_many_segments():
    """Two levels of boxes; points around a polygon of 2000 sides."""
    turn = np.linspace(0, 2 * np.pi, 2001)
    law = sm.DistanceSize(np.stack([np.cos(turn), np.sin(turn)], axis=1), 1, 2, 1)
    angle = np.random.default_rng(0).choice(turn, 50)
    for radius in (0.0, 0.5, 0.999, 1.0, 1.5, 40.0):
        points = radius * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        sagitta = 1 - np.cos(np.pi / 2000)
        assert law.distance(points) == pytest.approx(abs(radius - 1), abs=1.01 * sagitta)


def test_nothing_and_one_place():
    law = sm.DistanceSize(np.zeros((40, 1, 3)), 1, 2, 1)
    assert law(np.empty((0, 3))).shape == (0,)
    assert law([[3.0, 4.0, 0.0]]).tolist() == [2.0]
