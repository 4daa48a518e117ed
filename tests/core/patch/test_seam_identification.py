"""Joined sides become one curve in space: like the slow twin, and where that is no surface."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import seams
from naive.triangulation import corners, plane_triangulation

from surfmesh._core import NIL
from surfmesh._core.patch import identify_seams
from surfmesh._core.triangulation import DEAD


def sheet(columns, rows):
    """A grid of points (columns + 1) x (rows + 1), triangulated, its border the boundary.

    Returns tri, adj (3 m,), region (m,), vertices, and the nodes' vertices and segments: from the
    lower left corner counter-clockwise.
    """
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0))
    bulge = 0.01 * np.stack([y * (rows - y), x * (columns - x)], axis=-1)
    sign = np.sign(np.stack([x - columns / 2, y - rows / 2], axis=-1))
    t = plane_triangulation((np.stack([x, y], axis=-1) + sign * bulge).reshape(-1, 2))
    ghost = (corners(t) < 0).any(axis=1)
    number = np.cumsum(~ghost) - 1
    adj = np.where(ghost[t.adj // 3], NIL, 3 * number[t.adj // 3] + t.adj % 3)
    keep = np.repeat(~ghost, 3)
    grid = np.arange((columns + 1) * (rows + 1)).reshape(rows + 1, columns + 1)
    sides = [grid[0, :-1], grid[:-1, -1], grid[-1, :0:-1], grid[:0:-1, 0]]
    node = np.concatenate(sides).astype(np.int32)
    ring = np.arange(len(node))
    segments = np.stack([ring, np.roll(ring, -1)], axis=1).astype(np.int32)
    region = np.zeros(np.count_nonzero(~ghost), np.uint8)
    return t.tri[keep], adj[keep].astype(np.int32), region, grid.size, node, segments


def joined(count, *pairs):
    """The identity of nodes of which pairs, one after the other, are one."""
    identity = np.arange(count)
    for a, b in pairs:
        low, high = sorted((identity[a], identity[b]))
        identity[identity == high] = low
    return identity


def assert_like_the_twin(sheet, identity):
    tri, adj, region, vertices, node, segments = sheet
    found = identify_seams(tri, adj, region, vertices, node, segments, identity)
    wanted = seams.identified(
        tri.reshape(-1, 3).tolist(), adj.reshape(-1, 3).tolist(), region != DEAD, node.tolist(),
        segments.tolist(), identity.tolist(),
    )  # fmt: skip
    triangles, uv_triangles, vertex, bad = found
    assert [*map(tuple, triangles.reshape(-1, 3).tolist())] == wanted[0]
    assert [*map(tuple, uv_triangles.reshape(-1, 3).tolist())] == wanted[1]
    assert vertex.tolist() == wanted[2]
    assert bad.tolist() == wanted[3]
    return found


def west_and_east(columns, rows):
    """Pairs of nodes of the two upright sides of a sheet."""
    return [((2 * (columns + rows) - k) % (2 * (columns + rows)), columns + k)
            for k in range(rows + 1)]  # fmt: skip


@pytest.mark.parametrize("columns, is_surface", [(4, True), (3, True), (2, False), (1, False)])
def test_a_tube_needs_three_segments_around(columns, is_surface):
    grid = sheet(columns, 4)
    _, _, vertex, bad = assert_like_the_twin(grid, joined(len(grid[4]), *west_and_east(columns, 4)))
    assert len(vertex) == columns * 5
    assert (len(bad) == 0) == is_surface


def test_a_pole_takes_a_triangle_a_segment():
    grid = sheet(5, 3)
    identity = joined(len(grid[4]), *((k, k + 1) for k in range(5)))
    triangles, _, vertex, bad = assert_like_the_twin(grid, identity)
    assert len(vertex) == 24 - 5
    assert len(triangles) // 3 == len(grid[2]) - 5
    assert len(bad) == 0


def test_without_identification_all_stays():
    grid = sheet(3, 3)
    triangles, corners, vertex, bad = assert_like_the_twin(grid, np.arange(12))
    assert (triangles == corners).all() and (vertex == np.arange(16)).all() and len(bad) == 0


def test_dead_slots_are_left_out():
    tri, adj, region, vertices, node, segments = sheet(4, 4)
    dead = int(np.flatnonzero((adj.reshape(-1, 3) == NIL).sum(axis=1) == 0)[0])
    adj = adj.copy()
    adj[adj // 3 == dead] = NIL
    region[dead] = DEAD
    grid = tri, adj, region, vertices, node, segments
    triangles, *_ = assert_like_the_twin(grid, joined(16, *west_and_east(4, 4)))
    assert len(triangles) // 3 == len(region) - 1


@settings(max_examples=150)
@given(
    st.integers(1, 5),
    st.integers(1, 5),
    st.lists(st.tuples(st.integers(0, 19), st.integers(0, 19)), max_size=8),
)
def test_any_identification_is_like_the_twin(columns, rows, pairs):
    grid = sheet(columns, rows)
    count = len(grid[4])
    assert_like_the_twin(grid, joined(count, *((a % count, b % count) for a, b in pairs)))


def test_wrong_arguments_are_refused():
    tri, adj, region, vertices, node, segments = sheet(3, 3)
    identity = np.arange(len(node))
    for changed, message in [
        ((tri[3:], adj, region, vertices, node, segments, identity), "tri has"),
        ((tri, adj, region, 15, node, segments, identity), "tri has an index"),
        ((tri, adj, region, vertices, node + 5, segments, identity), "node has"),
        ((tri, adj, region, vertices, node, segments + 1, identity), "segments has"),
        ((tri, adj, region, vertices, node, segments, identity[1:]), "identity has"),
        ((tri, adj, region, vertices, node, segments, identity + 1), "identity has"),
    ]:
        with pytest.raises(ValueError, match=message):
            identify_seams(*changed)
