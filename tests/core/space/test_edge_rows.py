"""Rows of pairs of vertices among the edges of a table."""

import numpy as np
import pytest

from surfmesh._core.space import edge_rows, edge_table

BIG = 2_000_000_000


def rows_one_by_one(edges, pairs):
    known = {tuple(edge): row for row, edge in enumerate(edges.tolist())}
    return [known.get((min(pair), max(pair)), -1) for pair in pairs.tolist()]


@pytest.mark.parametrize("numbers", [np.arange(20), np.arange(20) * (BIG // 20)])
def test_rows_are_those_of_the_pairs_in_either_order(numbers):
    draw = np.random.default_rng(3)
    triangles = numbers[draw.integers(0, 20, (30, 3))].astype(np.int32)
    edges, _, _ = edge_table(triangles)
    others = np.array([(-1, 3), (5, -7), (BIG, BIG), (0, BIG)], np.int32)
    pairs = np.concatenate([edges[::-1], edges[:, ::-1], others])
    assert edge_rows(edges, np.ascontiguousarray(pairs)).tolist() == rows_one_by_one(edges, pairs)


def test_without_edges_there_are_no_rows():
    none = np.empty((0, 2), np.int32)
    assert edge_rows(none, np.array([(0, 1)], np.int32)).tolist() == [-1]
    assert edge_rows(none, none).tolist() == []


def test_edges_out_of_order_are_refused():
    with pytest.raises(ValueError, match="not in order"):
        edge_rows(np.array([(1, 2), (0, 1)], np.int32), np.array([(0, 1)], np.int32))
