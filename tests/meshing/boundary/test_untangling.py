"""Boundaries that cross themselves a little are taken apart; the rest stays where it is."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh.meshing.boundary.untangling import meeting_pairs, untangled


def ring(nodes):
    count = np.arange(len(nodes))
    return np.asarray(nodes, float), np.stack([count, np.roll(count, -1)], axis=1)


def signed_area(nodes):
    x, y = nodes.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def cusp(overlap, count=9):
    """A lune whose arcs meet in (1, 0) with no angle and cross before, by ``overlap``."""
    x = np.linspace(0.0, 1.0, count)
    bump = overlap * np.sin(np.pi * np.clip((x - 0.5) / 0.5, 0.0, 1.0))
    below = np.stack([x, -0.1 * (1.0 - x) ** 2 + bump], axis=1)
    above = np.stack([x, 0.1 * (1.0 - x) ** 2 - bump], axis=1)[::-1]
    return ring(np.concatenate([below, above[1:]]))


def test_a_simple_polygon_is_left_alone():
    nodes, segments = cusp(0.0)
    assert np.array_equal(untangled(nodes, segments, np.ones(len(nodes))), nodes)


def test_arcs_that_cross_before_their_cusp_are_parted():
    nodes, segments = cusp(0.02)
    assert len(meeting_pairs(nodes, segments)[0]) > 0
    moved = untangled(nodes, segments, np.full(len(nodes), 0.1))
    assert len(meeting_pairs(moved, segments)[0]) == 0
    assert signed_area(moved) == pytest.approx(signed_area(nodes), abs=0.02)
    assert np.linalg.norm(moved - nodes, axis=1).max() <= 0.1
    assert np.array_equal(moved[:3], nodes[:3])  # far from the crossing


def test_nothing_moves_farther_than_it_may():
    nodes, segments = cusp(0.02)
    assert untangled(nodes, segments, np.full(len(nodes), 1e-3)) is None


def test_a_node_on_a_segment_goes_inside():
    nodes, segments = ring([(0, 0), (4, 0), (4, 2), (2, 0), (0, 2)])
    moved = untangled(nodes, segments, np.full(5, 0.5))
    assert moved[3, 1] > 0.0 and np.array_equal(np.delete(moved, 3, 0), np.delete(nodes, 3, 0))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.0, 0.04))
def test_what_is_returned_is_simple_and_turns_left(seed, noise):
    random = np.random.default_rng(seed)
    nodes, segments = cusp(0.01, 12)
    nodes = nodes + noise * random.standard_normal(nodes.shape)
    moved = untangled(nodes, segments, np.full(len(nodes), 0.2))
    if moved is not None:
        assert len(meeting_pairs(moved, segments)[0]) == 0
        assert signed_area(moved) > 0.0
