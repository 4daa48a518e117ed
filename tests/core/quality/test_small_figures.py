"""Figures that the report asks for in one pass each, against numpy."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.quality import corner_places, solid_boxes, unused_vertex


def test_places_of_corners_are_distinct_pairs():
    draw = np.random.default_rng(2)
    triangles = draw.integers(0, 20, (60, 3)).astype(np.int32)
    uv_triangles = draw.integers(0, 50, (60, 3)).astype(np.int32)
    pairs = np.unique(np.stack([triangles.ravel(), uv_triangles.ravel()]), axis=1)
    found = corner_places(triangles, uv_triangles, 21, 50)
    assert found.tolist() == np.bincount(pairs[0], minlength=21).tolist()


def test_a_sphere_has_as_many_places_at_its_poles_as_triangles():
    mesh = sm.mesh(sm.load("sphere"), sm.Sizing(size=0.4))
    known = mesh.parametrisation
    found = corner_places(
        mesh.triangles, known.uv_triangles, len(mesh.points), len(known.uv_points)
    )
    assert np.count_nonzero(found > 4) == 2 and found.min() == 1


def test_the_first_vertex_of_no_triangle():
    triangles = np.array([(0, 1, 3), (3, 1, 0)], np.int32)
    assert unused_vertex(triangles, 4) == 2
    assert unused_vertex(np.array([(0, 1, 2)], np.int32), 3) == -1
    with pytest.raises(ValueError, match="out of range"):
        unused_vertex(triangles, 3)


def test_boxes_of_solids_are_those_of_their_triangles():
    draw = np.random.default_rng(5)
    points, triangles = draw.normal(size=(30, 3)), draw.integers(0, 30, (40, 3)).astype(np.int32)
    solids = draw.integers(-1, 3, (40, 2)).astype(np.int32)
    low, high = solid_boxes(points, triangles, solids, 4)
    for solid in range(3):
        here = points[triangles[(solids == solid).any(axis=1)]].reshape(-1, 3)
        assert (low[solid] == here.min(axis=0)).all() and (high[solid] == here.max(axis=0)).all()
    assert np.isposinf(low[3]).all() and np.isneginf(high[3]).all()
    with pytest.raises(ValueError, match="out of range"):
        solid_boxes(points, triangles, solids, 2)
