"""Segments that touch, overlap and cross become one graph; regions are inside by parity."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from naive import plane_graph

from surfmesh._core import insertion as core
from surfmesh._core.insertion import Recovery
from surfmesh.errors import DomainError
from surfmesh.geometry.planar.domain_faces import bounded_faces, inside_faces
from surfmesh.geometry.planar.noding import MERGE
from surfmesh.geometry.planar.segment_graph import Line, segment_graph

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)


def graph_of(outer=(SQUARE,), holes=(), constraints=(), points=(), split=True):
    loops = [(f"outer loop {k}", loop) for k, loop in enumerate(outer)]
    loops += [(f"hole {k}", loop) for k, loop in enumerate(holes)]
    lines = [Line(label, np.array(loop, float), True, k) for k, (label, loop) in enumerate(loops)]
    lines += [Line(f"constraint {k}", np.array(c, float)) for k, c in enumerate(constraints)]
    lines += [Line(f"point {k}", np.array([p], float)) for k, p in enumerate(points)]
    graph = segment_graph(lines, [False] * len(outer) + [True] * len(holes), split)
    assert graph.broken_invariant() is None
    return graph


def area(graph):
    return sum(face.area for face in inside_faces(graph))


def status_of_regions(graph, left, right):
    """The status, the region that contradicts, and which are inside; region 0 is infinite."""
    sides = np.stack([left, right], axis=1)
    return core.inside_regions(sides, graph.loop_segments, graph.loop_is_hole, 0)


def inside_regions(graph, left, right):
    status, _, inside = status_of_regions(graph, left, right)
    assert status == Recovery.FINISHED
    return inside.astype(bool)


def same(one, other):
    names = ("points", "segments", "lone_points", "loop_segments", "loop_is_hole")
    return all(np.array_equal(getattr(one, name), getattr(other, name)) for name in names)


def sorted_rows(rows):
    return sorted(map(tuple, np.asarray(rows).tolist()))


def test_a_square():
    graph = graph_of()
    assert sorted_rows(graph.points) == sorted_rows(SQUARE)
    assert graph.segments.tolist() == [[0, 1], [0, 2], [1, 3], [2, 3]]
    assert graph.loop_segments.tolist() == [[0, 0], [1, 0], [2, 0], [3, 0]]
    assert graph.segments.dtype == graph.lone_points.dtype == np.int32
    assert [graph.origin(s)[-9:] for s in range(4)] == [f"segment {k}" for k in (3, 0, 2, 1)]


def test_ends_on_segments_make_a_t():
    graph = graph_of(constraints=[[[0, 0.5], [1, 0.5]], [[0.5, 0.5], [0.5, 1]]], split=False)
    assert len(graph.points) == 8 and len(graph.segments) == 10
    origins = [graph.origin(segment) for segment in range(10)]
    assert origins.count("outer loop 0, segment 3") == origins.count("constraint 0, segment 0") == 2
    assert len(inside_faces(graph)) == 3


def test_proper_crossings_are_refused_with_both_names_or_split():
    lines = [[[0.2, 0.2], [0.5, 0.2], [0.8, 0.8]], [[0.2, 0.8], [0.8, 0.2]]]
    message = r"constraint 0, segment 1 crosses constraint 1, segment 0 at \(0.6, 0.4\)"
    with pytest.raises(DomainError, match=message):
        graph_of(constraints=lines, split=False)
    graph = graph_of(constraints=lines)
    assert len(graph.points) == 10 and len(graph.segments) == 9
    assert np.allclose(graph.points[-1], (0.6, 0.4), atol=1e-15)


def test_many_lines_through_one_point_share_one_vertex():
    turn = np.linspace(0, np.pi, 13)[:-1] + 0.1
    arms = 0.4 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    graph = graph_of(constraints=[(0.5 - arm, 0.5 + arm) for arm in arms])
    assert len(graph.points) == 4 + 24 + 1
    assert np.abs(graph.points - 0.5).max(axis=1).min() < 1e-15


def test_overlaps_are_one_segment_of_both():
    """Two squares side by side, one of them lower: half a side is shared."""
    graph = graph_of(outer=(SQUARE, SQUARE + (1, -0.5)), split=False)
    uses = np.bincount(graph.loop_segments[:, 0], minlength=len(graph.segments))
    shared = graph.segments[uses == 2]
    assert graph.points[shared[0]].tolist() == [[1, 0], [1, 0.5]] and len(shared) == 1
    assert area(graph) == 2.0


def test_a_spike_of_a_loop_is_a_constraint():
    """The loop runs out and back: an even number of times, so it bounds nothing there."""
    loop = [[0, 0], [1, 0], [1, 1], [0.5, 1], [0.5, 2], [0.5, 1], [0, 1]]
    graph = graph_of(outer=(loop,), split=False)
    assert len(graph.segments) == 6 and len(graph.loop_segments) == 5
    assert area(graph) == 1.0


def test_collinear_and_duplicate_points_are_kept_once():
    loop = [[0, 0], [0.5, 0], [0.5, 0], [1, 0], [1, 1], [1 + 1e-14, 1], [0, 1], [0, 0.25], [0, 0]]
    graph = graph_of(outer=(loop,), split=False)
    assert len(graph.points) == 6 and area(graph) == pytest.approx(1.0, abs=1e-12)


def test_lone_points():
    graph = graph_of(points=[(0.5, 0), (0.3, 0.3), (0, 0), (0.3, 0.3 + 1e-14)], split=False)
    assert graph.points[graph.lone_points].tolist() == [[0.3, 0.3]]
    assert len(graph.segments) == 5  # one point cuts a side


def test_a_constraint_that_is_one_point_is_a_point():
    graph = graph_of(constraints=[[[0.5, 0.5], [0.5, 0.5]]], split=False)
    assert graph.points[graph.lone_points].tolist() == [[0.5, 0.5]]


def test_short_segments_and_sharp_corners_survive():
    tooth = [[0, 0], [1, 0], [1, 1], [0.5, 1], [0.5 - 1e-6, 1], [0.5 - 1e-6, 1 - 1e-6], [0, 1]]
    assert len(graph_of(outer=(tooth,), split=False).segments) == 7
    degree = np.radians(1.0)
    needle = [[0, 0], [1, 0], [np.cos(degree), np.sin(degree)]]
    assert area(graph_of(outer=(needle,), split=False)) == pytest.approx(0.5 * np.sin(degree))


@pytest.mark.parametrize("loop", [[[0, 0], [1, 1], [2, 2]], [[0, 0], [1, 0], [0.5, 1e-14]]])
def test_loops_without_area_are_refused(loop):
    with pytest.raises(DomainError, match="outer loop 1 encloses no area"):
        graph_of(outer=(SQUARE, loop))


@pytest.mark.parametrize("factor, reason", [(1e300, "too far away"), (1e-200, "too small")])
def test_extreme_coordinates_are_refused(factor, reason):
    with pytest.raises(DomainError, match=reason):
        graph_of(outer=(factor * SQUARE,))


def test_far_from_the_origin():
    graph = graph_of(outer=(SQUARE + 1e9,), constraints=[[[1e9, 1e9], [1e9 + 1, 1e9 + 1]]])
    assert len(graph.points) == 4 and len(graph.segments) == 5


@pytest.mark.parametrize("noise", [1e-15, 1e-13, 5e-12, 3e-11])
@pytest.mark.parametrize("seed", range(5))
def test_points_a_little_farther_apart_than_the_merging_distance(seed, noise):
    """With one distance for both merging and cutting, three such points cut each other's
    segments in turn for ever."""
    random = np.random.default_rng(seed)
    lattice = random.integers(0, 5, (30, 2, 2)) / 4 + noise * random.normal(size=(30, 2, 2))
    graph_of(constraints=lattice)
    angle = random.uniform(0, 2 * np.pi, 12)
    arms = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    graph_of(constraints=np.stack([-arms, arms], 1) + noise * random.normal(size=(12, 2, 2)))


grid_points = arrays(np.int64, (12, 2, 2), elements=st.integers(0, 8))
any_points = arrays(np.float64, (12, 2, 2), elements=st.floats(0, 1, width=32))


@settings(max_examples=40)
@given(st.one_of(grid_points, any_points))
def test_after_splitting_nothing_crosses(lines):
    """Against the exact twin; with everything in the graph that was given."""
    graph = graph_of(constraints=lines.astype(float))
    assert plane_graph.first_meeting(graph.points, graph.segments) is None
    spread = max(1.0, np.abs(lines).max())
    for end in lines.reshape(-1, 2):
        assert np.abs(graph.points - end).max(axis=1).min() <= 8 * MERGE * spread


@settings(max_examples=30)
@given(arrays(np.float64, (8, 2), elements=st.floats(-1, 2, width=16)))
def test_the_regions_fill_the_outline(star):
    """A polygon that may cross itself, and a square: the mesher's view of what is inside."""
    try:
        graph = graph_of(outer=(SQUARE, star), holes=(0.25 + 0.5 * SQUARE,))
    except DomainError as error:
        assert "no area" in str(error)
        return
    polygons, around = bounded_faces(graph)
    left, right = plane_graph.sides(graph, polygons)
    wanted = around[:, :2].sum(axis=1) > around[:, 2]
    found = inside_regions(graph, left, right)
    assert not found[0] and found[1:].tolist() == wanted.tolist()


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.sampled_from([2.0**-30, 1e-9, 1e-3, 1e3, 1e9]))
def test_direction_start_and_size_do_not_matter(seed, factor):
    random = np.random.default_rng(seed)
    turn = np.sort(random.uniform(0, 2 * np.pi, 12))
    loop = random.uniform(0.5, 1, (12, 1)) * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    lines = random.uniform(-1, 1, (6, 2, 2))
    graph = graph_of(outer=(loop,), constraints=lines)
    other = np.roll(loop[::-1], random.integers(12), axis=0)
    assert same(graph, graph_of(outer=(other,), constraints=lines[:, ::-1]))

    larger = graph_of(outer=(factor * loop,), constraints=factor * lines)
    assert np.array_equal(larger.segments, graph.segments)
    assert np.array_equal(larger.loop_segments, graph.loop_segments)
    assert np.allclose(larger.points, factor * graph.points, rtol=0, atol=1e-12 * factor)


@pytest.mark.parametrize("turn", [0.1, 1.0, 2.5])
def test_turning_keeps_what_meets(turn):
    """A lattice with Ts, overlaps and crossings; turned, its ends are only nearly on lines."""
    rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    ticks = np.linspace(0, 1, 8)
    lines = [[[x, 0], [x, 1]] for x in ticks] + [[[0, y], [1, y]] for y in ticks]
    lines += [[[0, 0], [1, 1]], [[0, 1], [1, 0]], [[0.2, 0], [0.7, 0]]]
    plain = graph_of(constraints=lines)
    turned = graph_of(outer=(SQUARE @ rotation,), constraints=np.array(lines) @ rotation)
    assert len(turned.points) == len(plain.points) == 64 + 2 + 1
    assert len(turned.segments) == len(plain.segments)
    assert len(inside_faces(turned)) == len(inside_faces(plain))


def test_regions():
    """An island in a hole, a line that ends freely, and one that divides."""
    graph = graph_of(
        outer=(4 * SQUARE, 1.5 + SQUARE),
        holes=(1 + 2 * SQUARE,),
        constraints=[[[0, 0.5], [0.5, 0.5]], [[1.5, 1.5], [2.5, 2.5]]],
    )
    polygons, _ = bounded_faces(graph)
    left, right = plane_graph.sides(graph, polygons)
    inside = inside_regions(graph, left, right)
    assert sorted(p.area for p, k in zip(polygons, inside[1:]) if k) == [0.5, 0.5, 12.0]
    assert np.count_nonzero(inside) == 3


def test_wrong_regions_are_refused():
    graph = graph_of(constraints=[[[0, 0.5], [1, 0.5]]])
    polygons, _ = bounded_faces(graph)
    left, right = plane_graph.sides(graph, polygons)
    outside, other = np.where(left == 0, left, 4), np.where(right == 0, right, 4)
    assert status_of_regions(graph, outside, other)[:2] == (Recovery.UNREACHABLE_REGION, 1)
    outside, other = np.where(left == 2, 0, left), np.where(right == 2, 0, right)
    assert status_of_regions(graph, outside, other)[0] == Recovery.DIFFERENT_LOOPS


def test_check_names_what_is_broken():
    graph = graph_of(points=[(0.5, 0.5)])
    crossed = np.array([[0, 1], [0, 4], [1, 3], [2, 4]], np.int32)
    for broken, words in (
        (dict(points=np.full((5, 2), np.nan)), "not finite"),
        (dict(points=np.zeros((5, 2))), "at one place"),
        (dict(segments=graph.segments + 9), "segments: a number is out of range"),
        (dict(segments=graph.segments[:, ::-1]), "smaller point first"),
        (dict(segments=graph.segments[[0, 0, 1, 2]]), "there twice"),
        (dict(lone_points=np.array([0])), "ends a segment"),
        (dict(lone_points=np.array([], np.int32)), "not used"),
        (dict(loop_segments=graph.loop_segments[:3]), "is not closed"),
        (dict(segments=crossed, loop_segments=graph.loop_segments[:0]), "a point is not used|ends"),
    ):
        assert re.search(words, replace(graph, **broken).broken_invariant())
    moved = graph.points.copy()
    moved[graph.lone_points] = (0.5, 0.0)
    assert "other than at a common end" in replace(graph, points=moved).broken_invariant()
