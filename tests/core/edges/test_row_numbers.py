"""Rows of parts, and numbers of nodes."""

import numpy as np
import pytest

from surfmesh._core.edges import node_numbers, rows_of

FIRST = np.array([0, 4, 4, 6, 9])


@pytest.mark.parametrize("which", [[], [0], [1], [3, 0, 3], [2, 1, 0]])
def test_rows_are_those_of_each_part_in_turn(which):
    rows = rows_of(FIRST, np.array(which, int))
    slow = [row for part in which for row in range(FIRST[part], FIRST[part + 1])]
    assert rows.tolist() == slow and rows.dtype == np.int64


def test_parts_that_are_none():
    with pytest.raises(ValueError, match="which"):
        rows_of(FIRST, np.array([4]))
    with pytest.raises(ValueError, match="first"):
        rows_of(np.array([0, 4, 2]), np.array([0]))


def test_ends_have_the_numbers_of_vertices_and_others_count_on():
    first, ends = np.array([0, 4, 6, 9]), np.array([[0, 1], [1, 2], [2, 2]])
    found = node_numbers(first, ends, np.empty(0, int), 10)
    assert found.tolist() == [0, 10, 11, 1, 1, 2, 2, 12, 2]
    known = np.array([0, 77, 78, 1, -1, -1, -1, -1, -1])
    assert node_numbers(first, ends, known, 100).tolist() == [0, 77, 78, 1, 1, 2, 2, 100, 2]


def test_edges_without_nodes_are_refused():
    with pytest.raises(ValueError, match="two nodes"):
        node_numbers(np.array([0, 1]), np.array([[0, 1]]), np.empty(0, int), 5)
    with pytest.raises(ValueError, match="known"):
        node_numbers(np.array([0, 2]), np.array([[0, 1]]), np.zeros(1, int), 5)
