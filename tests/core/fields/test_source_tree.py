"""Backgrounds grown from sources against all sources at all points."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.sources import graded_sizes, is_balanced, leaves

from surfmesh.errors import SizingError
from surfmesh.sizing.field.boundary_field import source_background

SLOPE = 2.0 * 0.2 / 2.2  # a growth of 1.2
UNIT = (0.0, 0.0, 1.0, 1.0)
ISOTROPIC = np.array([1.0, 0.0, 1.0])


def sizes(background, xy):
    return background.scalar_sizes(xy)


def corners(found):
    """Corners (leaves, 4, 2) in the background's order."""
    k = np.arange(4)
    x = found[:, :1] + found[:, 2:3] * (k % 2)
    y = found[:, 1:2] + found[:, 3:4] * (k // 2)
    return np.stack([x, y], axis=-1)


def check(background, place, size, largest, slope, metric=ISOTROPIC):
    """Nodes lie where the leaves meet and are exact; leaves beside each other are alike."""
    found = leaves(background)
    node = background.corner[found[:, 4].astype(int)]
    at = np.full((len(background.metric_root), 2), np.nan)
    at[node.ravel()] = corners(found).reshape(-1, 2)
    assert np.isfinite(at).all()  # every node is a corner
    scale = np.abs(at).max()
    np.testing.assert_allclose(at[node], corners(found), atol=1e-9 * scale)  # and of one place
    assert len(np.unique(np.round(at / scale, 12), axis=0)) == len(at)
    exact = graded_sizes(at, place, size, largest, slope, metric)
    np.testing.assert_allclose(1.0 / background.metric_root[:, 3], exact, rtol=1e-7)
    assert is_balanced(found)


@settings(max_examples=25, deadline=None)
@given(
    st.integers(0, 10_000), st.integers(1, 25), st.sampled_from([0.0, 2.0, 6.0]),
    st.sampled_from([0.02, SLOPE, 0.4]), st.floats(0.0, np.pi), st.sampled_from([1.0, 3.0, 100.0]),
)  # fmt: skip
def test_nodes_are_exact_and_the_tree_is_balanced(seed, n, decades, slope, angle, stretch):
    rng = np.random.default_rng(seed)
    c, s = np.cos(angle), np.sin(angle)
    metric = np.array([c * c + s * s * stretch, c * s * (1 - stretch), s * s + c * c * stretch])
    place = rng.uniform(-0.2, 1.2, (n, 2))
    size = 10.0 ** rng.uniform(-decades - 1, 0, n)
    largest = 10.0 ** rng.uniform(-1, 0.5)
    background = source_background(place, size, largest, slope, UNIT, metric)
    if len(background.child) > 8_000:
        return  # all right, but too slow to look at naively
    check(background, place, size, largest, slope, metric)
    xy = rng.uniform(0, 1, (300, 2))
    exact = graded_sizes(xy, place, size, largest, slope, metric)
    error = sizes(background, xy) / exact - 1
    assert error.max() < 0.11 and error.min() > -0.11  # the tips of steep cones, and ridges
    assert np.quantile(np.abs(error), 0.9) < 0.05


@pytest.mark.parametrize("shape", ["square", "circle"])
@pytest.mark.parametrize("n", [40, 400])
def test_within_five_percent_along_a_boundary(shape, n):
    """Growth 1.2, sources one size apart: at the sources, at the boundary and inside."""
    t = np.arange(n) / n
    if shape == "circle":
        xy = 0.5 + 0.5 * np.stack([np.cos(2 * np.pi * t), np.sin(2 * np.pi * t)], axis=1)
        size = np.full(n, np.pi / n)
    else:
        k, f = np.divmod(4 * t, 1)
        x, y = [f, 1 + 0 * f, 1 - f, 0 * f], [0 * f, f, 1 + 0 * f, 1 - f]
        xy = np.stack([np.choose(k.astype(int), p) for p in (x, y)], axis=1)
        size = np.full(n, 4 / n)
    background = source_background(xy, size, 1.0, SLOPE, UNIT)
    check(background, xy, size, 1.0, SLOPE)
    assert (sizes(background, xy) / size).max() < 1.066
    assert (sizes(background, xy) / size).mean() < 1.05
    inside = np.random.default_rng(1).uniform(0.15, 0.85, (2000, 2))
    error = sizes(background, inside) / graded_sizes(inside, xy, size, 1.0, SLOPE) - 1
    assert np.abs(error).max() < 0.07 and np.quantile(np.abs(error), 0.99) < 0.05
    assert len(background.child) < 30 * n  # near the boundary, not everywhere


def test_size_tensors_are_the_size_times_the_inverse_root_of_the_metric():
    metric = np.array([4.0, 1.0, 3.0])
    place, size = np.array([[0.3, 0.6]]), np.array([0.1])
    background = source_background(place, size, 0.5, SLOPE, UNIT, metric)
    xy = np.random.default_rng(2).uniform(0, 1, (50, 2))
    for (h11, h12, h22), s in zip(background.sizes(xy), sizes(background, xy)):
        inverse = np.linalg.inv([[h11, h12], [h12, h22]]) * s
        np.testing.assert_allclose(inverse @ inverse, [[4.0, 1.0], [1.0, 3.0]], rtol=1e-9)


@pytest.mark.parametrize("n", [0, 1, 7])
def test_nothing_below_the_largest_size_is_one_cell(n):
    place, size = np.random.default_rng(n).uniform(0, 1, (n, 2)), np.full(n, 0.3)
    background = source_background(place, size, 0.3, SLOPE, (0.0, 0.0, 1.0, 0.8))
    assert len(background.child) == 1
    assert sizes(background, np.array([[0.2, 0.7]])) == pytest.approx(0.3)


def test_equal_sizes_a_little_below_the_largest_are_not_worth_a_split():
    place = np.random.default_rng(3).uniform(0, 1, (4, 2))
    background = source_background(place, np.full(4, 0.097), 0.1, SLOPE, UNIT)
    assert background.child.max() < 0


def test_a_source_of_a_millionth_of_the_box():
    place, size = np.array([[0.30001, 0.7]]), np.array([1e-6])
    background = source_background(place, size, 0.2, SLOPE, UNIT)
    check(background, place, size, 0.2, SLOPE)
    assert sizes(background, place) == pytest.approx(1e-6, rel=0.1)
    assert len(background.child) < 3000


def test_coincident_sources_count_as_the_smallest():
    place = np.full((50, 2), 0.4)
    size = np.geomspace(1e-3, 1.0, 50)[::-1].copy()
    one = source_background(place[-1:], size[-1:], 0.2, SLOPE, UNIT)
    many = source_background(place, size, 0.2, SLOPE, UNIT)
    xy = np.random.default_rng(4).uniform(0, 1, (200, 2))
    np.testing.assert_allclose(sizes(many, xy), sizes(one, xy), rtol=0.06)
    check(many, place, size, 0.2, SLOPE)


def test_sources_outside_the_box_act_in_it():
    place, size = np.array([[-0.5, 0.5], [2.0, 3.0]]), np.array([1e-4, 1e-3])
    background = source_background(place, size, 10.0, SLOPE, UNIT)
    check(background, place, size, 10.0, SLOPE)
    assert sizes(background, np.array([[0.0, 0.5]])) == pytest.approx(0.5 * SLOPE, rel=0.01)


@pytest.mark.parametrize("height", [1e-3, 1e-6])
def test_a_strip_has_cells_along_it_only(height):
    x = np.linspace(0, 1, 30)
    place = np.concatenate([np.stack([x, 0 * x], 1), np.stack([x, 0 * x + height], 1)])
    size = np.full(60, 1 / 30)
    background = source_background(place, size, 1.0, SLOPE, (0.0, 0.0, 1.0, height))
    assert len(background.child) < 2000
    xy = np.random.default_rng(5).uniform(0, 1, (300, 2)) * [1, height]
    exact = graded_sizes(xy, place, size, 1.0, SLOPE)
    np.testing.assert_allclose(sizes(background, xy), exact, rtol=0.1)


@pytest.mark.parametrize("factor", [1e-9, 1e9])
def test_scale_does_not_matter(factor):
    rng = np.random.default_rng(6)
    place, size = rng.uniform(0, 1, (20, 2)), rng.uniform(0.01, 0.1, 20)
    one = source_background(place, size, 0.2, SLOPE, UNIT)
    other = source_background(
        factor * place, factor * size, 0.2 * factor, SLOPE, (0.0, 0.0, factor, factor)
    )
    assert (one.child == other.child).all()
    np.testing.assert_allclose(factor * other.metric_root, one.metric_root, rtol=1e-9)


@pytest.mark.parametrize(
    "box, metric",
    [((0, 0, 0, 1), ISOTROPIC), ((0, 1, 1, 1), ISOTROPIC), (UNIT, np.array([1.0, 1.0, 1.0]))],
)
def test_no_area_is_refused(box, metric):
    with pytest.raises(SizingError):
        source_background(np.zeros((1, 2)), np.ones(1), 2.0, SLOPE, box, metric)
