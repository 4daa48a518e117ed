"""Gradation along edges against Dijkstra's algorithm over all samples, cuts against np.interp."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from surfmesh._core import surfaces
from surfmesh._core.edges import (
    CurvePieces,
    cut_to_metric_length,
    edge_courses,
    graded_along_edges,
)


def network(draw, count, vertices):
    """Edges between random vertices with random samples; some join a vertex to itself."""
    ends = draw.integers(0, vertices, size=(count, 2))
    first = np.cumsum([0, *draw.integers(3, 9, size=count)])
    return draw.normal(size=(first[-1], 3)), first, ends


def naive_gradation(points, sizes, first, ends, vertices, slope):
    node = vertices + np.arange(len(points))
    node[first[:-1]], node[first[1:] - 1] = ends.T
    root, links = vertices + len(points), {}
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    for edge in range(len(ends)):
        for i in range(first[edge], first[edge + 1] - 1):
            key = tuple(sorted((node[i], node[i + 1])))
            links[key] = min(links.get(key, np.inf), steps[i])
    for i, size in enumerate(sizes):
        links[node[i], root] = min(links.get((node[i], root), np.inf), size / slope)
    row, column = np.array(list(links)).T
    graph = coo_matrix((list(links.values()), (row, column)), (root + 1, root + 1)).tocsr()
    return slope * dijkstra(graph, directed=False, indices=root)[node]


@given(seed=st.integers(0, 1000))
def test_sizes_are_those_of_the_shortest_ways(seed):
    draw = np.random.default_rng(seed)
    points, first, ends = network(draw, int(draw.integers(1, 9)), 5)
    sizes = draw.uniform(0.1, 20.0, size=len(points))
    found = graded_along_edges(points, sizes, first, ends, 5, 0.3, 0.0)
    assert np.array_equal(found, naive_gradation(points, sizes, first, ends, 5, 0.3))


def line_pieces(count, draw):
    lines = [surfaces.line(draw.normal(size=3), draw.normal(size=3)) for _ in range(count)]
    return CurvePieces(lines, np.zeros(count), draw.uniform(1.0, 5.0, size=count))


def test_pieces_have_the_same_metric_length():
    draw = np.random.default_rng(3)
    curves, t = line_pieces(4, draw), np.linspace(0.0, 1.0, 33)
    which, first, fraction = np.arange(4), np.arange(5) * 33, np.tile(t, 4)
    points = edge_courses(curves, which, first, fraction, np.ones(4, np.uint8))[0]
    sizes = draw.uniform(0.2, 0.6, size=len(points))
    ends, corners = np.arange(8).reshape(4, 2), draw.normal(size=(8, 3))
    given_t = np.array([0.0, 0.3, 1.0])  # of the third edge
    start, found_t, places, found, refused, _ = cut_to_metric_length(
        curves, points, fraction, sizes, first, ends, corners, which, np.full(4, 2),
        np.array([0, 0, 0, 3, 3]), given_t, np.full(4, np.inf), np.zeros(4), 1e6,
    )  # fmt: skip
    assert refused == -1
    for edge in range(4):
        at, own = slice(first[edge], first[edge + 1]), slice(start[edge], start[edge + 1])
        step = np.linalg.norm(np.diff(points[at], axis=0), axis=1)
        size = sizes[at]
        metric = np.r_[0.0, np.cumsum(2.0 * step / (size[1:] + size[:-1]))]
        pieces = max(2, round(metric[-1]))
        expected = np.interp(np.arange(pieces + 1) / pieces * metric[-1], metric, t)
        expected[0], expected[-1] = 0.0, 1.0
        expected = given_t if edge == 2 else expected
        assert np.array_equal(found_t[own], expected)
        assert np.array_equal(found[own], np.interp(expected, t, size))
        assert np.array_equal(places[own][[0, -1]], corners[ends[edge]])
        assert np.allclose(
            places[own][1:-1],
            curves.points(np.array([edge]), np.array([0, len(expected)]), expected)[1:-1],
        )


def test_too_many_pieces_are_refused_by_their_row():
    draw = np.random.default_rng(4)
    curves, fraction = line_pieces(2, draw), np.tile(np.linspace(0.0, 1.0, 33), 2)
    first, which = np.array([0, 33, 66]), np.arange(2)
    points = edge_courses(curves, which, first, fraction, np.ones(2, np.uint8))[0]
    sizes = np.r_[np.full(33, 10.0), np.full(33, 1e-9)]
    found = cut_to_metric_length(
        curves, points, fraction, sizes, first, np.zeros((2, 2), int), np.zeros((1, 3)), which,
        np.ones(2, int), np.zeros(3, int), np.empty(0), np.full(2, np.inf), np.zeros(2), 1000.0,
    )  # fmt: skip
    assert found[4] == 1 and found[5] > 1e6


def cut_ellipse(semi_axes, size, chord, shortest=0.0, samples=33, most=1e6):
    """Nodes of three quarters of an ellipse, how far its pieces sag, what is refused."""
    curve = surfaces.ellipse(np.zeros(3), np.eye(3)[0], np.eye(3)[1], *semi_axes)
    pieces = CurvePieces([curve], np.zeros(1), np.array([1.5 * np.pi]))
    which, first, t = np.array([0]), np.array([0, samples]), np.linspace(0.0, 1.0, samples)
    points = edge_courses(pieces, which, first, t, np.zeros(1, np.uint8))[0]
    _, found, nodes, _, refused, _ = cut_to_metric_length(
        pieces, points, t, np.full(samples, size), first, np.array([[0, 1]]), points[[0, -1]],
        which, np.ones(1, int), np.zeros(2, int), np.empty(0), np.array([chord]),
        np.array([shortest]), most,
    )  # fmt: skip
    if refused >= 0:
        return nodes, np.empty(0), refused
    between = (found[:-1, None] + np.diff(found)[:, None] * np.linspace(0.0, 1.0, 33)).ravel()
    arcs = pieces.points(np.array([0]), np.array([0, len(between)]), between)
    ways = arcs.reshape(-1, 33, 3) - nodes[:-1, None]
    chords = np.diff(nodes, axis=0)[:, None]
    share = (ways * chords).sum(axis=2) / (chords * chords).sum(axis=2)
    sags = np.linalg.norm(ways - np.clip(share, 0.0, 1.0)[..., None] * chords, axis=2).max(axis=1)
    return nodes, sags, refused


@given(
    narrow=st.floats(0.05, 1.0), size=st.floats(0.1, 5.0), chord=st.sampled_from([0.1, 0.01, 1e-3])
)
def test_no_piece_sags_by_more_than_its_chord(narrow, size, chord):
    nodes, sags, refused = cut_ellipse((1.0, narrow), size, chord)
    assert refused == -1 and sags.max() <= chord
    free, _, _ = cut_ellipse((1.0, narrow), size, np.inf)
    assert len(nodes) >= len(free)


def test_where_no_piece_sags_too_much_none_is_added():
    nodes, sags, _ = cut_ellipse((1.0, 0.5), 0.1, 1.0)
    assert len(nodes) == len(cut_ellipse((1.0, 0.5), 0.1, np.inf)[0]) and sags.max() < 0.01


def test_short_pieces_may_sag():
    nodes, sags, _ = cut_ellipse((1.0, 0.2), 0.5, 1e-3, shortest=0.4)
    lengths = np.linalg.norm(np.diff(nodes, axis=0), axis=1)
    assert sags.max() > 1e-3 and lengths[sags > 1e-3].max() <= 0.4


def test_a_circle_sags_as_it_is_known_to():
    circle = surfaces.ellipse(np.zeros(3), np.eye(3)[0], np.eye(3)[1], 2.0, 2.0)
    pieces = CurvePieces([None, circle], np.zeros(2), np.array([0.0, np.pi]))
    sag, length = pieces.sags(1, np.array([0.0, 0.5, 0.75, 1.0]))
    half = np.array([0.25, 0.125, 0.125]) * np.pi
    assert np.allclose(sag, 2.0 - 2.0 * np.cos(half)) and np.allclose(length, 4.0 * np.sin(half))
    for which, fraction in ((0, [0.0, 1.0]), (2, [0.0, 1.0]), (1, [0.0])):
        with pytest.raises(ValueError):
            pieces.sags(which, np.array(fraction))


def test_pieces_for_the_chord_are_counted_too():
    assert cut_ellipse((1.0, 1.0), 0.5, 1e-6, most=100.0)[2] == 0


def test_circles_turn_by_their_angle():
    circle = surfaces.ellipse(np.zeros(3), np.eye(3)[0], np.eye(3)[1], 2.0, 2.0)
    pieces = CurvePieces([circle, None], np.zeros(2), np.array([np.pi, 0.0]))
    t = np.linspace(0.0, 1.0, 65)
    points, tangent, curvature, total = edge_courses(
        pieces, np.array([0]), np.array([0, 65]), t, np.zeros(1, np.uint8)
    )
    assert np.allclose(np.linalg.norm(points, axis=1), 2.0) and np.allclose(curvature, 0.5)
    assert np.allclose(np.linalg.norm(tangent, axis=1), 1.0)
    assert total == pytest.approx(np.pi)


@pytest.mark.parametrize(
    "which, first", [([1], [0, 1]), ([2], [0, 1]), ([0], [0, 2]), ([0], [1, 1])]
)
def test_bad_indices_are_refused(which, first):
    circle = surfaces.ellipse(np.zeros(3), np.eye(3)[0], np.eye(3)[1], 2.0, 2.0)
    pieces = CurvePieces([circle, None], np.zeros(2), np.ones(2))
    with pytest.raises(ValueError, match=r"which|first"):
        pieces.points(np.array(which), np.array(first), np.zeros(1))
