"""The loop of rounds with smaller sizes: when it ends, and what it hands on."""

import numpy as np

from surfmesh.meshing.patch.refinement_loop import (
    MAX_ROUNDS_WITHOUT_BEST,
    MAX_STALLED_ROUNDS,
    StagnationCheck,
    refined_in_rounds,
)
from surfmesh.sizing.rules.size_limits import SizeLimits


def test_refinements_of_all_rounds_are_joined_by_face():
    seen = []

    def one_round(limits):
        seen.append({face: limit.sizes.tolist() for face, limit in limits.items()})
        more = SizeLimits(np.zeros((1, 3)), np.array([1.0 / len(seen)]), 0.2)
        return len(seen), {} if len(seen) == 4 else {len(seen) % 2: more}

    assert refined_in_rounds(one_round, SizeLimits.joined_with) == 4
    assert seen == [{}, {1: [1.0]}, {1: [1.0], 0: [0.5]}, {1: [1 / 3, 1.0], 0: [0.5]}]


def test_the_last_round_is_the_result_whatever_it_asks_for():
    rounds = []

    def one_round(limits):
        rounds.append(limits[7])
        return len(rounds), {7: 0.5 * limits[7]}

    assert refined_in_rounds(one_round, lambda lower, _: lower, rounds=3, limits={7: 1.0}) == 3
    assert rounds == [1.0, 0.5, 0.25]


def test_refinements_are_given_up_when_nothing_changes_and_not_before():
    check = StagnationCheck()
    for places, triangles in ((50, 900), (20, 950), (19, 1100)):  # fewer, or at least finer
        check.record(places, triangles)
        assert not check.is_stalled and not check.is_unchanged
    for _ in range(MAX_STALLED_ROUNDS):
        assert not check.is_stalled
        check.record(19, 1101)
    assert check.is_stalled and check.is_unchanged
    check.record(3, 1101)
    assert not check.is_stalled and not check.is_unchanged


def test_a_mesh_that_becomes_finer_is_given_up_without_a_new_best():
    check = StagnationCheck()
    for k in range(MAX_ROUNDS_WITHOUT_BEST + 1):
        assert not check.is_stalled
        check.record(20, 1000 * 2**k)
    assert check.is_stalled


def test_a_face_that_has_grown_without_end_is_given_up():
    check = StagnationCheck()
    for nodes in (400, 1600, 3000):
        check.record(12, 0, failed=True, nodes=nodes)
        assert not check.is_stalled
    check.record(12, 0, failed=True, nodes=8 * 400 + 1)
    assert check.is_stalled


def test_crossings_that_only_become_more_are_given_up():
    check = StagnationCheck()
    for places in (42, 90):
        check.record(places, 0, failed=True, nodes=100)
        assert not check.is_stalled
    check.record(183, 0, failed=True, nodes=150)
    assert check.is_stalled
