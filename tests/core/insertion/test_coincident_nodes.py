"""Step 1 of section 3: nodes of one number at one place are one node."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core.insertion import coincident_nodes, loop_nodes

SAME_PLACE, NEAR_STEP = 1e-6, 0.1


def naive(uv, numbers, segments):
    """For each node the first that has its number and its place."""
    place = uv / np.maximum(np.ptp(uv, axis=0), np.finfo(float).tiny)
    near = np.full(len(uv), np.inf)
    for a, b in segments:
        step = np.linalg.norm(place[b] - place[a])
        near[a], near[b] = min(near[a], step), min(near[b], step)
    near = np.maximum(NEAR_STEP * near, SAME_PLACE)
    kept = list(range(len(uv)))
    for k in range(len(uv)):
        for earlier in range(k):
            apart = np.linalg.norm(place[k] - place[earlier])
            if numbers[k] == numbers[earlier] and apart <= max(near[k], near[earlier]):
                kept[k] = kept[earlier]
                break
    return np.array(kept)


@st.composite
def boundaries(draw):
    """Loops on a coarse grid, some nodes a little off it; few numbers for many nodes."""
    lengths = draw(st.lists(st.integers(1, 8), min_size=1, max_size=4))
    total = sum(lengths)
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    uv = rng.integers(0, 5, (total, 2)) + rng.choice([0.0, 1e-7, 1e-3, 0.2], (total, 2))
    return uv, rng.integers(0, draw(st.integers(1, 12)), total), np.array(lengths)


def rings(lengths):
    first = np.cumsum([0, *lengths])
    ring = [start + np.arange(n) for start, n in zip(first, lengths)]
    return np.concatenate([np.stack([r, np.roll(r, -1)], axis=1) for r in ring])


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # all nodes of a loop may be at one place
@settings(max_examples=200)
@given(boundaries())
def test_like_the_twin(boundary):
    uv, numbers, lengths = boundary
    along = rings(lengths)
    wanted, wanted_row = np.unique(naive(uv, numbers, along), return_inverse=True)
    nodes, row = coincident_nodes(uv, numbers, along)
    assert nodes.tolist() == wanted.tolist() and row.tolist() == wanted_row.tolist()

    nodes, segments, identity, runs_twice = loop_nodes(uv, numbers, lengths)
    assert nodes.tolist() == wanted.tolist()
    ends = wanted_row[along]
    ends = ends[ends[:, 0] != ends[:, 1]]
    assert segments.tolist() == ends.tolist()
    assert runs_twice == (len(np.unique(ends, axis=0)) < len(ends))
    kept = numbers[nodes].tolist()
    assert identity.tolist() == [kept.index(number) for number in kept]


def test_an_edge_inside_is_walked_there_and_back():
    uv = np.array([(0, 0), (1, 0), (1, 1), (0.5, 0.5), (1, 1), (0, 1)], float)
    numbers = np.array([10, 11, 12, 13, 12, 14])
    nodes, segments, identity, runs_twice = loop_nodes(uv, numbers, np.array([6]))
    assert nodes.tolist() == [0, 1, 2, 3, 5]
    assert segments.tolist() == [[0, 1], [1, 2], [2, 3], [3, 2], [2, 4], [4, 0]]
    assert identity.tolist() == [0, 1, 2, 3, 4] and not runs_twice


def test_a_seam_keeps_both_places():
    uv = np.array([(0, 0), (3, 0), (3, 1), (0, 1)], float)
    nodes, _, identity, _ = loop_nodes(uv, np.array([5, 5, 6, 6]), np.array([4]))
    assert nodes.tolist() == [0, 1, 2, 3] and identity.tolist() == [0, 0, 2, 2]


def test_a_loop_that_runs_twice_the_same_way():
    uv = np.array([(0, 0), (1, 0), (0, 1), (0, 0), (1, 0), (0, 1)], float)
    assert loop_nodes(uv, np.array([0, 1, 2, 0, 1, 2]), np.array([3, 3]))[3]
    back = [0, 1, 2, 3, 5, 4]
    assert not loop_nodes(uv[back], np.array([0, 1, 2, 0, 2, 1]), np.array([3, 3]))[3]


def test_wrong_arguments_are_refused():
    uv, numbers = np.zeros((4, 2)), np.arange(4)
    with pytest.raises(ValueError, match="lengths do not add up"):
        loop_nodes(uv, numbers, np.array([3]))
    with pytest.raises(ValueError, match="lengths has a negative"):
        loop_nodes(uv, numbers, np.array([5, -1]))
    with pytest.raises(ValueError, match="numbers has 3 rows"):
        loop_nodes(uv, numbers[1:], np.array([4]))
    with pytest.raises(ValueError, match="segments has an index"):
        coincident_nodes(uv, numbers, np.array([[0, 4]]))
