"""Sizes along edges that meet: as far as their directions let them differ."""

import numpy as np
import pytest

from surfmesh.meshing.edges.edge_gradation import graded_by_direction


def at_the_corner(angle, ratio):
    """Sizes of a long edge that meets one of size 1 at ``angle`` degrees."""
    way = np.linspace(0.0, 10.0, 21)
    turned = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0])
    points = [way[:, None] * turned, way[:, None] * [1.0, 0.0, 0.0]]
    ways = np.array([[turned, turned], [[1.0, 0.0, 0.0]] * 2])
    sizes = [np.full(21, 100.0), np.ones(21)]
    return graded_by_direction(points, sizes, ways, np.array([[0, 1], [0, 2]]), 0.2, ratio)[0]


@pytest.mark.parametrize("angle", [0.0, 180.0])
def test_edges_of_one_line_are_alike_and_grow(angle):
    np.testing.assert_allclose(at_the_corner(angle, 50.0), 1.0 + 0.2 * np.linspace(0, 10, 21))


@pytest.mark.parametrize("angle", [45.0, 60.0, 80.0])
def test_a_size_holds_for_its_part_on_another_line(angle):
    assert at_the_corner(angle, 50.0)[0] == pytest.approx(1.0 / np.cos(np.radians(angle)))


def test_edges_at_right_angles_differ_by_the_ratio_at_most():
    assert at_the_corner(90.0, 7.0)[0] == pytest.approx(7.0)
    assert (at_the_corner(90.0, 200.0) == 100.0).all()
