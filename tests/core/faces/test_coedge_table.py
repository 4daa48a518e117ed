"""Boundaries of faces, from the nodes of the edges of a model."""

import numpy as np
import pytest

from surfmesh._core.edges import CurvePieces
from surfmesh._core.faces import CoedgeTable
from surfmesh.geometry.cad_surfaces.curves import Line

CORNERS = np.array([[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [6.0, 2.0, 0.0]])


def line(start, end):
    start, end = np.array(start, float), np.array(end, float)
    return Line(origin=start, direction=end - start).core


def table(edge=(0, 1, 2, 0)):
    """Face 0: edges 0, 1 and 2, a point; face 1: edge 0, backwards."""
    ways = [((2, 1), (6, 1)), ((6, 1), (6, 3)), ((6, 3), (2, 1)), ((0, 0), (4, 4))]
    pcurves = CurvePieces([line(*way) for way in ways], np.zeros(4), np.ones(4))
    return CoedgeTable(
        pcurves, np.array(edge), np.array([0, 0, 0, 1], np.uint8), np.array([0, 3, 4]),
        np.array([0, 1, 2]), np.array([0.5, 0.25, 0.125]), np.array([0, 1, 2]), CORNERS,
    )  # fmt: skip


FIRST = np.array([0, 3, 5, 5])
T = np.array([0.0, 0.25, 1.0, 0.0, 1.0])
POINTS = np.arange(15.0).reshape(5, 3)
NODES = FIRST, T, POINTS, np.array([0, 7, 1, 1, 2]), np.arange(1.0, 6.0)


def test_coedges_are_walked_as_their_loops_run():
    other, one = table().boundaries(np.array([1, 0]), *NODES)
    assert one.uv.tolist() == [
        [2, 1], [3, 1], [6, 1], [6, 1], [6, 3], [6, 3], [2, 1],
    ]  # fmt: skip
    assert one.numbers.tolist() == [0, 7, 1, 1, 2, 2, 2]
    assert one.sizes.tolist() == [1, 2, 3, 4, 5, np.inf, np.inf]
    assert np.array_equal(one.points, [*POINTS, CORNERS[2], CORNERS[2]])
    assert one.degenerate.tolist() == [0, 0, 1] and one.has_degenerate
    assert one.piece_end.tolist() == [3, 5, 7] and one.loop_end.tolist() == [3]
    assert one.tolerance.tolist() == [0.5, 0.25, 0.125]
    assert other.uv.tolist() == [[4, 4], [1, 1], [0, 0]] and other.numbers.tolist() == [1, 7, 0]
    assert other.tolerance.tolist() == [0.5] and other.box == ((0.0, 4.0), (0.0, 4.0))


def test_what_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="edge has an index"):
        table(edge=(0, 1, 3, 0))
    with pytest.raises(ValueError, match="faces has an index"):
        table().boundaries(np.array([2]), *NODES)
    with pytest.raises(ValueError, match="two nodes"):
        table().boundaries(np.array([0]), np.array([0, 4, 5, 5]), *NODES[1:])
    with pytest.raises(ValueError, match="points has"):
        table().boundaries(np.array([0]), FIRST, T, POINTS[:4], *NODES[3:])
