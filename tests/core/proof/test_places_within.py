"""Where triangles are looked at in a grid of places, what lies between these is bounded as well."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh._core import proof

SIDE = 25  # no multiple of the core's own grids
WEIGHTS = np.array(
    [(i, j, SIDE - i - j) for i in range(SIDE + 1) for j in range(SIDE + 1 - i)]
) / float(SIDE)
HEIGHT, WHOLE = 0, 8

GRAPHS = {
    "cubic": "u**3 + 2*u**2*v - v**3",
    "quartic": "u**4 - 3*u**2*v**2 + u*v**3",
    "waves": "sin(3*u)*cos(2*v)",
    "bell": "exp(-2*u**2 - v**2)",
}
SURFACES = {
    name: sm.ParametricSurface("u", "v", z, u=(-2, 2), v=(-2, 2)).core for name, z in GRAPHS.items()
}


def bounds_of(surface, uv, corners, limits):
    rims = np.zeros(len(uv), np.uint8)
    return proof.triangle_bounds(surface, corners, uv, np.zeros_like(uv), limits, rims, 0)


def sampled(surface, uv, corners):
    """Largest height and distance, point by point; areas (twice) over squares of longest sides."""
    at = np.einsum("qk,mkd->mqd", WEIGHTS, uv)
    points = surface.evaluate(at.reshape(-1, 2), 0)[0].reshape(len(uv), -1, 3)
    away = points - np.einsum("qk,mkd->mqd", WEIGHTS, corners)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normal, axis=1)
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    height = np.abs(np.einsum("mqd,md->mq", away, normal / area[:, None])).max(axis=1)
    return height, np.linalg.norm(away, axis=2).max(axis=1), area / longest**2


@pytest.mark.parametrize("name", SURFACES)
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), size=st.floats(0.05, 1.5),
       times=st.sampled_from([0.6, 0.98, 1.02, 1.2, 3.0, 100.0]))  # fmt: skip
def test_no_sample_is_beyond_bounds_that_a_limit_asks_for(name, seed, size, times):
    surface, draw = SURFACES[name], np.random.default_rng(seed)
    uv = draw.uniform(-2, 2 - size, (6, 1, 2)) + size * draw.uniform(0, 1, (6, 3, 2))
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    height, whole, shape = sampled(surface, uv, corners)
    found = bounds_of(surface, uv, corners, times * whole)
    rounding = 1e-13 * (1.0 + np.abs(corners).max())
    good = shape > 1e-3
    assert (whole <= found[:, WHOLE] + rounding).all()
    assert (height <= found[:, HEIGHT] + rounding)[good].all()


def test_bounds_are_tight_where_second_derivatives_change_over_a_triangle():
    """The largest of them at the corners, averaged, says up to an eighth more."""
    surface = SURFACES["cubic"]
    uv = np.array([
        [[0.5, 0.2], [1.1, 0.1], [0.7, 0.7]],
        [[-1.0, 1.0], [-0.4, 1.2], [-0.9, 1.6]],
        [[0.3, 0.2], [0.9, 0.1], [0.6, 0.7]],
    ])  # fmt: skip
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    height, _, _ = sampled(surface, uv, corners)
    found = bounds_of(surface, uv, corners, np.full(3, 10.0))
    assert (found[:, HEIGHT] < 1.05 * height).all()


def test_fourth_derivatives_that_do_not_change_leave_nothing_open():
    """But for what R - L may rise by between places: a 36th."""
    surface = SURFACES["quartic"]
    draw = np.random.default_rng(3)
    uv = draw.uniform(-2, 1, (40, 1, 2)) + draw.uniform(0, 1, (40, 3, 2))
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    height, _, shape = sampled(surface, uv, corners)
    found = bounds_of(surface, uv, corners, np.full(len(uv), 100.0))
    good = shape > 0.05
    assert np.median(found[good, HEIGHT] / height[good]) < 1.05


def test_many_triangles_are_bounded_in_parts_that_lie_beside_each_other():
    """None is left out, in whatever order they come."""
    surface, draw = SURFACES["waves"], np.random.default_rng(8)
    start = draw.uniform(-2, 1.9, (2500, 1, 2))
    uv = start + 0.1 * draw.uniform(0, 1, (2500, 3, 2))
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    height, whole, shape = sampled(surface, uv, corners)
    found = bounds_of(surface, uv, corners, 1.05 * whole)
    assert (found[:, WHOLE] >= whole - 1e-14).all()
    assert (found[:, HEIGHT] >= height - 1e-14)[shape > 1e-3].all()
    assert np.median(found[:, WHOLE] / whole) < 1.05
    order = draw.permutation(len(uv))
    again = bounds_of(surface, uv[order], corners[order], 1.05 * whole[order])
    np.testing.assert_allclose(again[:, WHOLE], found[order, WHOLE], rtol=0.1, atol=1e-12)


def test_no_triangles_have_no_bounds():
    nothing = np.empty((0, 3, 2)), np.empty((0, 3, 3)), np.empty(0)
    assert bounds_of(SURFACES["waves"], *nothing).shape == (0, 29)
