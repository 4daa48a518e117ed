"""The metric area within loops against a dense sum, and against areas that are known."""

import numpy as np
import pytest
from naive.background import constant_background, random_tree

from surfmesh.geometry.inside_loops import is_inside

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def area_within(field, *loops):
    return field.metric_area_within(np.concatenate(loops), np.cumsum([0, *map(len, loops)]))


def star(centre, largest, corners, seed):
    """A loop that is not convex."""
    radius = np.random.default_rng(seed).uniform(0.3 * largest, largest, corners)
    angle = 2 * np.pi * np.arange(corners) / corners
    return centre + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def test_areas_that_are_known():
    field = constant_background(0.5, 3.0, 2.0)
    hole, islet = 0.2 + 0.6 * SQUARE, 0.4 + 0.2 * SQUARE
    for turned in (slice(None), slice(None, None, -1)):
        found = area_within(field, SQUARE, hole[turned], islet)
        assert found == pytest.approx(4.0 * (1.0 - 0.36 + 0.04), rel=1e-12)
    touching = np.array([[1.0, 0.0], [2.0, 0.5], [1.0, 1.0]])
    assert area_within(field, SQUARE, touching) == pytest.approx(4.0 * 1.5, rel=1e-12)


def test_of_loops_that_leave_the_box_what_lies_in_it():
    field = constant_background(0.5, 1.0, 1.0)
    assert area_within(field, 3.0 * SQUARE - 1.0) == pytest.approx(4.0, rel=1e-12)
    assert area_within(field, SQUARE + 0.5) == pytest.approx(1.0, rel=1e-12)
    assert area_within(field, SQUARE + 2.0) == 0.0


def test_loops_without_area_and_none():
    field = constant_background(0.5, 1.0, 1.0)
    assert area_within(field, SQUARE[:2], SQUARE[:0], SQUARE[[0, 1, 0]]) == 0.0
    assert field.metric_area_within(np.empty((0, 2)), np.zeros(1, np.int64)) == 0.0


@pytest.mark.parametrize("seed", range(4))
def test_against_a_dense_sum(seed):
    tree = random_tree(seed, 3, 2, 5)
    nx, ny = tree.grid
    extent = np.array([nx, ny]) / tree.box[2:4]
    centre = tree.box[:2] + 0.5 * extent
    least = extent.min()
    loops = [star(centre, 0.45 * least, 23, seed), star(centre, 0.1 * least, 11, seed + 9)]
    n = 2000
    x, y = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n)
    points = tree.box[:2] + np.stack([x.ravel(), y.ravel()], axis=1) * extent
    points = points[is_inside(loops, points)]
    a = tree.metric_roots(points)
    dense = (a[:, 0] * a[:, 2] - a[:, 1] ** 2).sum() * extent.prod() / n**2
    assert area_within(tree, *loops) == pytest.approx(dense, rel=2e-3)


def test_what_is_no_loop_is_refused():
    field = constant_background(0.5, 1.0, 1.0)
    for corners, first in (
        (SQUARE, [0, 3]), (SQUARE, [0, 5, 4]), (SQUARE, []), (np.full((3, 2), np.nan), [0, 3]),
    ):  # fmt: skip
        with pytest.raises(ValueError):
            field.metric_area_within(corners, np.array(first, np.int64))
