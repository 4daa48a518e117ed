"""Section 3 step by step: the triangulation is whole, and areas exact, after each of them."""

import numpy as np
import pytest
from naive.background import constant_background
from naive.exact import polygon_area, triangles_area
from naive.polygons import square, star
from naive.triangulation import check_triangulation, corners, live_triangles

from surfmesh._core import insertion as core
from surfmesh._core.insertion import APART, AROUND, LOWEST, Recovery
from surfmesh._core.triangulation import INSIDE
from surfmesh.meshing.patch.packing import packed

HOLES = [square(20), square(1, 0.1, 0.4)[::-1], star(5, 0.5, 0.1, (0.7, 0.7), 0.2)[::-1]]


def constant(h):
    """A packing of circles of size h, and their background."""
    background = constant_background(h, 1.0, 1.0)
    packing = packed(background, (0.0, 0.0, 1.0, 1.0), (0.5, 0.5), 2000, 20_000)
    return packing.t, background


def ring(first, count):
    nodes = first + np.arange(count)
    return np.stack([nodes, np.roll(nodes, -1)], axis=1)


def nodes_and_segments(polygons):
    first = np.cumsum([0, *map(len, polygons)])
    segments = [ring(start, len(polygon)) for start, polygon in zip(first, polygons)]
    return np.concatenate(polygons), np.concatenate(segments).astype(np.int32)


def test_each_step_keeps_the_triangulation_of_the_plane():
    nodes, segments = nodes_and_segments(HOLES)
    t, background = constant(0.05)
    assert check_triangulation(t) is None
    made = core.insert_boundary(t, background, nodes, segments, np.empty((0, 2), np.int32))
    assert made.outcome.status == Recovery.FINISHED
    assert t.vertices == 0  # used up
    t = made.t
    assert (t.xy[made.vertex] == nodes).all()
    assert (t.tri[made.edge] == made.vertex[segments[:, 0]]).all()
    assert t.fixed[made.edge].all() and fixed(t) == 2 * len(segments)
    used = np.unique(corners(t)[live_triangles(t)])
    moved = made.first_node + len(nodes) - (len(used) - 1)  # vertices that became nodes, or left
    assert check_triangulation(t, moved) is None
    assert made.grow_inside() == Recovery.FINISHED
    assert check_triangulation(t, moved) is None
    area = sum(polygon_area(p) for p in HOLES)
    assert inside_area(t) == area
    removed = made.clear_boundary()
    assert removed > 0
    assert made.outcome.status == Recovery.FINISHED
    assert check_triangulation(t, moved + removed) is None
    assert inside_area(t) == area
    made.swap_bad()
    assert check_triangulation(t, moved + removed) is None
    assert inside_area(t) == area
    assert fixed(t) == 2 * len(segments)


def flooded(t, edge):
    """Slow twin of ``grow_inside``; None for a leak."""
    inside, stack = set(), list(edge // 3)
    while stack:
        if (k := stack.pop()) not in inside:
            inside.add(k)
            half_edges = np.arange(3 * k, 3 * k + 3)
            if (t.tri[half_edges] < 0).any():
                return None
            stack += (t.adj[half_edges[t.fixed[half_edges] == 0]] // 3).tolist()
    return sorted(inside)


LINE_INSIDE = np.array([(0.3, 0.5), (0.4, 0.5), (0.5, 0.5)])


@pytest.mark.parametrize(
    ("polygons", "line"),
    [
        (HOLES, False), ([square(20)], False), ([square(20)], True),
        ([square(4, 0.2, 0.4)], False),  # most lies outside
        ([square(20)[::-1]], False),  # the wrong way round
        (HOLES[:1] + [square(1, 0.1, 0.4)], False),  # an island the wrong way round
    ],
)  # fmt: skip
def test_what_lies_inside_is_all_that_is_reached(polygons, line):
    nodes, segments = nodes_and_segments(polygons)
    if line:  # walked there and back
        there = len(nodes) + np.array([[0, 1], [1, 2]], np.int32)
        nodes, segments = np.vstack([nodes, LINE_INSIDE]), np.vstack([segments, there])
    t, background = constant(0.05)
    made = core.insert_boundary(t, background, nodes, segments, np.empty((0, 2), np.int32))
    assert made.outcome.status == Recovery.FINISHED
    expected = flooded(made.t, made.edge)
    grown = made.grow_inside()
    assert grown == (Recovery.LEAK if expected is None else Recovery.FINISHED)
    if expected is not None:
        assert np.flatnonzero(made.t.region == INSIDE).tolist() == expected


def fixed(t):
    """How many half-edges are fixed."""
    return np.count_nonzero(t.fixed.reshape(-1, 3)[live_triangles(t)])


def inside_area(t):
    return triangles_area(t.xy, corners(t)[t.region == INSIDE].tolist())


@pytest.mark.parametrize("h", [0.03, 0.05, 0.11])
def test_a_row_of_vertices_stands_along_the_boundary(h):
    t, background = constant(h)
    angle = np.arange(40) * (2.0 * np.pi / 40)
    circle = 0.5 + 0.4 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    row = core.apexes(background, circle, ring(0, 40))
    first = core.insert_row(t, background, row)
    used = np.unique(corners(t)[live_triangles(t)])
    used = used[used >= 0]
    assert check_triangulation(t, t.vertices - len(used)) is None
    new = t.xy[used[used >= first]]
    apart = np.linalg.norm(new[:, None] - new, axis=2) + 9.0 * np.eye(len(new))
    assert apart.min() > 0.5 * APART * h  # two that join meet half-way
    old = t.xy[used[used < first]]
    assert np.linalg.norm(new[:, None] - old, axis=2).min() > 0.9 * AROUND * h
    length = np.linalg.norm(circle[1] - circle[0])
    height = np.sqrt(max(h * h - 0.25 * length**2, (LOWEST * h) ** 2))
    inside = 0.4 * np.cos(np.pi / 40) - height
    assert np.allclose(np.linalg.norm(row - 0.5, axis=1), inside)


def test_two_nodes_at_one_place_have_no_apex():
    nodes = np.array([(0.2, 0.2), (0.2, 0.2), (0.3, 0.2)])
    row = core.apexes(constant(0.1)[1], nodes, np.array([[0, 1], [1, 2]]))
    assert np.allclose(row, [(0.25, 0.2 + 0.1 * np.sqrt(0.75))])


def recover(t=None, nodes=None, segments=None, identity=None):
    packing, background = constant(0.2)
    given_nodes, given_segments = nodes_and_segments([square(3)])
    nodes = given_nodes if nodes is None else nodes
    return core.recover(
        packing if t is None else t,
        background,
        nodes,
        given_segments if segments is None else segments,
        np.empty((0, 2), np.int32),
        np.arange(len(nodes)) if identity is None else identity,
    )


def test_wrong_arguments_are_refused():
    nodes, segments = nodes_and_segments([square(3)])
    domain = recover().domain
    with pytest.raises(ValueError, match="no triangulation of the plane"):
        recover(t=domain.t)
    for number in (-1, len(nodes)):
        with pytest.raises(ValueError, match="segments has an index"):
            recover(segments=np.where(segments == 2, number, segments))
    with pytest.raises(ValueError, match="identity has an index"):
        recover(identity=np.arange(len(nodes)) + 1)
    with pytest.raises(ValueError, match="identity has 3 rows"):
        recover(identity=np.arange(3))
    for value in (np.nan, np.inf):
        with pytest.raises(ValueError, match="nodes has a place that is not finite"):
            recover(nodes=np.where(nodes == 1.0, value, nodes))
    with pytest.raises(TypeError):
        recover(segments=segments[:, :1])


def test_what_is_in_the_way_is_named():
    nodes, segments = nodes_and_segments([square(3)])
    nodes[5] = nodes[2]
    taken = recover(nodes=nodes).outcome
    assert (taken.status, taken.number) == (Recovery.NODE_TAKEN, 5)
    nodes, segments = nodes_and_segments([square(3)])
    crossed = recover(segments=np.concatenate([segments, [[1, 7], [2, 10]]])).outcome
    assert (crossed.status, crossed.number) == (Recovery.CROSSING, len(segments) + 1)
    leaking = recover(segments=segments[:-1]).outcome
    assert leaking.status == Recovery.LEAK


def test_memory_outlives_what_owned_it():
    tri = recover().domain.t.tri
    assert tri.min() == 0 and tri.max() < len(tri)
