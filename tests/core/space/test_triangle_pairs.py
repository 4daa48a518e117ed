"""Triangles that meet, against clipping in rational arithmetic."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import meeting as slow
from naive.exact import sign

from surfmesh._core.space import meeting_triangles, orient_space, triangles_meet
from surfmesh.quality.measures.self_intersection import meeting_pairs
from surfmesh.result.surface_mesh import SurfaceMesh

coarse = st.integers(-2, 2).map(float)  # many coincidences
seeds = st.integers(0, 2**31)


def meet(first, second):
    found = triangles_meet(np.array([*first, *second], float))
    assert found == triangles_meet(np.array([*second, *first], float))
    return found


@given(st.lists(st.tuples(*[st.floats(-1e3, 1e3).map(lambda x: round(x, 9))] * 3), min_size=4,
                max_size=4))  # fmt: skip
def test_orientation_has_the_sign_of_fractions(points):
    found = orient_space(np.array(points))
    assert sign(found) == sign(slow.orient_space(*points))


@given(seeds)
def test_orientation_of_points_that_are_nearly_in_a_plane(seed):
    rng = np.random.default_rng(seed)
    a, b, c = rng.normal(size=(3, 3))
    s, t = rng.normal(size=2)
    points = np.array([a, b, c, a + s * (b - a) + t * (c - a)]) + rng.choice([0, 100])
    found = orient_space(points)
    assert sign(found) == sign(slow.orient_space(*points))
    assert sign(orient_space(points[[1, 0, 2, 3]])) == -sign(found)


@settings(max_examples=200)
@given(st.lists(st.tuples(coarse, coarse, coarse), min_size=6, max_size=6))
def test_triangles_on_a_coarse_grid(points):
    assert meet(points[:3], points[3:]) == slow.meet(points[:3], points[3:])


@settings(max_examples=150)
@given(st.lists(st.tuples(coarse, coarse), min_size=6, max_size=6), st.integers(0, 2), seeds)
def test_triangles_in_one_plane(points, shared, seed):
    rng = np.random.default_rng(seed)
    u, v = rng.integers(-3, 4, (2, 3))
    space = np.array(points) @ np.array([u, v]).astype(float)
    space[3 : 3 + shared] = space[:shared]
    space = space / 3.0  # rounded: no longer quite in the plane
    assert meet(space[:3], space[3:]) == slow.meet(space[:3], space[3:])


@settings(max_examples=150)
@given(st.integers(0, 3), seeds)
def test_triangles_at_random(shared, seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(6, 3))
    points[3 : 3 + shared] = points[:shared]
    points[3:] = rng.permutation(points[3:])
    if seed % 2:
        points = np.round(2 * points) / 7
    assert meet(points[:3], points[3:]) == slow.meet(points[:3], points[3:])


FLAT = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]


@pytest.mark.parametrize(
    "other, expected",
    [
        ([(0.2, 0.2, -1), (0.2, 0.2, 1), (2, 2, 0)], True),  # through the middle
        ([(0.2, 0.2, 0), (0.2, 0.3, 1), (0.3, 0.2, 1)], True),  # stands on it
        ([(0.2, 0.2, 1e-300), (0.2, 0.3, 1), (0.3, 0.2, 1)], False),  # almost
        ([(0, 0, 0), (-1, 0, 0), (0, -1, 0)], False),  # touches in a corner
        ([(0, 0, 0), (1, 1, 0), (-1, 1, 1)], True),  # shares a corner, cuts the third side
        ([(0, 0, 0), (1, 0, 0), (0, -1, 0)], False),  # neighbours in a plane
        ([(0, 0, 0), (1, 0, 0), (0.2, 0.1, 0)], True),  # folded onto it
        ([(0, 0, 0), (1, 0, 0), (0.2, 0.1, 1e-18)], False),  # nearly
        ([(0, 0, 0), (2, 0, 0), (0, -1, 0)], True),  # sides lie on each other: T
        ([(0.1, 0.1, 0), (0.2, 0.1, 0), (0.1, 0.2, 0)], True),  # within it
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], True),  # the same
        ([(0, 0, 0), (0.5, 0.5, 0), (1, 1, 0)], False),  # without area
    ],
)
def test_known_pairs(other, expected):
    assert meet(FLAT, other) is expected
    if other[0][2] != 1e-300:
        for scale in (1e-9, 1e9):
            assert meet(np.multiply(FLAT, scale), np.multiply(other, scale)) is expected


@settings(max_examples=15)
@given(st.integers(2, 30), st.floats(0.05, 1.0), seeds)
def test_all_pairs_of_a_soup(count, size, seed):
    rng = np.random.default_rng(seed)
    corners = rng.uniform(size=(count, 1, 3)) + size * rng.normal(size=(count, 3, 3))
    points = corners.reshape(-1, 3)
    triangles = np.arange(3 * count).reshape(-1, 3)
    mesh = SurfaceMesh(points=points, triangles=triangles)
    assert [tuple(pair) for pair in meeting_pairs(mesh)] == slow.meeting_pairs(points, triangles)


@settings(max_examples=5)
@given(st.integers(0, 600), st.floats(0.02, 0.2), seeds)
def test_pairs_below_several_levels_of_the_tree(count, size, seed):
    rng = np.random.default_rng(seed)
    corners = rng.uniform(size=(count, 1, 3)) ** 3 + size * rng.normal(size=(count, 3, 3))
    low, high = corners.min(axis=1), corners.max(axis=1)
    near = (low[:, None] <= high).all(axis=2) & (low <= high[:, None]).all(axis=2)
    pairs = np.argwhere(np.triu(near, 1))
    expected = [(a, b) for a, b in pairs.tolist() if triangles_meet(corners[[a, b]].reshape(6, 3))]
    triangles = np.arange(3 * count, dtype=np.int32).reshape(-1, 3)
    found = meeting_triangles(corners.reshape(-1, 3), triangles, 10**6)
    assert sorted(map(tuple, found.tolist())) == expected


def test_many_pairs():
    count = 150  # triangles that all go through the middle
    rng = np.random.default_rng(0)
    points = rng.normal(size=(count, 3, 3))
    points[:, 2] = -points[:, :2].sum(axis=1)
    mesh = SurfaceMesh(points=points.reshape(-1, 3), triangles=np.arange(3 * count).reshape(-1, 3))
    assert len(meeting_pairs(mesh)) == count * (count - 1) // 2
    in_two_leaves = 16  # the search ends after them
    found = meeting_triangles(mesh.points, mesh.triangles, 1000)
    assert len(found) in range(1000, 1000 + in_two_leaves)
    assert len(meeting_triangles(mesh.points, mesh.triangles, 0)) == 0


def test_wrong_shapes_are_refused():
    with pytest.raises(ValueError, match="corners has 5 rows instead of 6"):
        triangles_meet(np.zeros((5, 3)))
    with pytest.raises(ValueError, match="corners has 3 rows instead of 4"):
        orient_space(np.zeros((3, 3)))
    with pytest.raises(ValueError, match="out of range"):
        meeting_triangles(np.zeros((2, 3)), np.array([[0, 1, 2]], np.int32), 10)


def test_zero_and_minus_zero_are_one_place():
    """Neighbours whose common corner has zeros of both signs touch there, and do not meet."""
    assert not meet(FLAT, [(-0.0, -0.0, 0.0), (-1.0, 0.0, -0.0), (0.0, -1.0, 0.0)])
