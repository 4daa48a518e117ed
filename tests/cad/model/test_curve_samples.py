"""Points of many coedges and edges at once: the same bits as of each alone."""

import cadquery as cq
import numpy as np
import pytest

from surfmesh.cad.cadquery.from_cadquery import from_cadquery
from surfmesh.cad.model.curve_samples import points_of, uv_of, walked

FRACTION = np.array([0.0, 0.3, 1.0])


@pytest.fixture(scope="module")
def model():
    return from_cadquery(cq.Workplane().cylinder(2, 1).faces(">Z").hole(0.5))


def test_coedges(model):
    coedges = [coedge for face in model.faces for coedge in face.coedges]
    assert any(coedge.reversed for coedge in coedges)
    for coedge, uv, walk in zip(coedges, uv_of(coedges, FRACTION), walked(coedges, FRACTION)):
        assert np.array_equal(uv, coedge.uv(FRACTION))
        assert np.array_equal(walk, coedge.walk(FRACTION))


def test_edges(model):
    for edge, points in zip(model.edges, points_of(model.edges, FRACTION)):
        assert np.array_equal(points, edge.evaluate(FRACTION, 0)[0])
    assert points_of([], FRACTION).shape == (0, 3, 3)
    degenerate = from_cadquery(cq.Workplane().sphere(1)).edges
    with pytest.raises(ValueError, match="degenerate"):
        points_of(degenerate, FRACTION)
