"""Splines of the core against the definition of B-splines, and at knots, ends and seams."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import nurbs as naive

from surfmesh._core import surfaces

NO_LIMITS = (np.nan, np.nan, 0.0)
NUMBERS = [(s - l, l) for s in range(4) for l in range(s + 1)]


def random_knots(rng, degree, spans):
    """Uneven, with repeated knots inside, clamped at one end only."""
    inner = np.sort(rng.uniform(0.0, 1.0, spans - 1))
    inner = np.repeat(inner, rng.integers(1, degree + 1, len(inner)))
    before = np.sort(rng.uniform(-1.0, 0.0, degree))
    return np.concatenate([before, [0.0], inner, np.ones(degree + 1)])


def curve(knots, control, t, order, dimension, limits=NO_LIMITS):
    weights = control[:, dimension] if control.shape[1] > dimension else None
    first, last, period = limits
    points = np.zeros((len(control), max(dimension, 2)))  # a function is a curve on an axis
    points[:, :dimension] = control[:, :dimension]
    core = surfaces.spline_curve(knots, points, weights, (first, last), period)
    assert core.dimension == points.shape[1]
    return core.evaluate(np.atleast_1d(np.asarray(t, dtype=float)), order)[..., :dimension]


def surface(knots_u, knots_v, control, uv, order, limits=NO_LIMITS * 2):
    weights = control[..., 3] if control.shape[2] > 3 else None
    u0, u1, period_u, v0, v1, period_v = limits
    core = surfaces.spline_surface(
        ((u0, u1), (v0, v1)), knots_u, knots_v, control[..., :3], weights, (period_u, period_v)
    )
    return core.evaluate(uv, order)


def basis(knots, degree, t, order, limits=NO_LIMITS):
    """The span, the parameter brought into it, the functions and their derivatives."""
    return surfaces.spline_basis(knots, degree, t, order, *limits)


@settings(deadline=None, max_examples=30)
@given(st.integers(1, 7), st.integers(1, 4), st.integers(0, 10_000))
def test_basis_functions_are_those_of_the_definition(degree, spans, seed):
    rng = np.random.default_rng(seed)
    knots = random_knots(rng, degree, spans)
    t = rng.uniform(0.0, 1.0)
    span, local, out = basis(knots, degree, t, 3)
    assert local == t
    assert knots[span] <= t < knots[span + 1]
    for k in range(4):
        expected = [
            naive.basis(knots, degree, i, t, k) if k <= degree else 0.0
            for i in range(span - degree, span + 1)
        ]
        assert out[k] == pytest.approx(expected, rel=1e-8, abs=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("degree", [1, 3, 25])
def test_basis_functions_add_up_to_one_and_their_derivatives_to_nothing(degree):
    rng = np.random.default_rng(degree)
    knots = random_knots(rng, degree, 6)
    for t in rng.uniform(0.0, 1.0, 20):
        _, _, out = basis(knots, degree, t, 3)
        assert (out[0] >= 0.0).all()
        assert out[0].sum() == pytest.approx(1.0, abs=1e-13)
        assert np.abs(out[1:].sum(axis=1) / np.abs(out[1:]).max(axis=1).clip(1)).max() < 1e-12


@pytest.mark.parametrize("weight", [None, 0.75])
def test_derivatives_keep_their_digits_far_from_the_origin(weight):
    rng = np.random.default_rng(3)
    knots = random_knots(rng, 3, 5)
    count = len(knots) - 4
    near = rng.integers(-99, 100, (count, count, 3)).astype(float)
    far = near + [2.0**40, -(2.0**41), 0.0]  # exact
    uv = rng.uniform(0, 1, (20, 2))
    if weight:
        weights = rng.uniform(weight, 1, (count, count, 1))
        near, far = np.concatenate([near, weights], -1), np.concatenate([far, weights], -1)
    assert np.array_equal(
        surface(knots, knots, near, uv, 3)[1:], surface(knots, knots, far, uv, 3)[1:]
    )
    near, far = near[0], far[0]
    assert np.array_equal(
        curve(knots, near, uv[:, 0], 3, 3)[1:], curve(knots, far, uv[:, 0], 3, 3)[1:]
    )


@settings(deadline=None, max_examples=20)
@given(st.integers(1, 4), st.integers(1, 4), st.booleans(), st.integers(0, 10_000))
def test_surfaces(degree_u, degree_v, rational, seed):
    rng = np.random.default_rng(seed)
    knots_u, knots_v = random_knots(rng, degree_u, 2), random_knots(rng, degree_v, 3)
    shape = len(knots_u) - degree_u - 1, len(knots_v) - degree_v - 1
    control = rng.normal(size=(*shape, 3))
    weights = rng.uniform(0.5, 2.0, shape) if rational else np.ones(shape)
    given_control = control
    if rational:
        given_control = np.concatenate([control, weights[..., None]], -1)
    uv = rng.uniform(0, 1, (2, 2))
    for order in range(4):
        found = surface(knots_u, knots_v, given_control, uv, order)
        assert len(found) == len([n for n in NUMBERS if sum(n) <= order])
        for point, (u, v) in enumerate(uv):
            expected = naive.surface(knots_u, knots_v, control, weights, u, v, order)
            for number, key in enumerate(NUMBERS[: len(found)]):
                scale = np.abs(expected[key]).max()
                assert found[number, point] == pytest.approx(
                    expected[key], rel=1e-7, abs=1e-9 * (1 + scale)
                )


def test_a_rational_curve_is_divided_by_its_weights():
    # a quarter of the unit circle; |c'| etc. from c.c = 1 differentiated
    half = np.sqrt(0.5)
    control = np.array([[1, 0, 1], [1, 1, half], [0, 1, 1.0]])
    knots = np.array([0, 0, 0, 1, 1, 1.0])
    c = curve(knots, control, np.linspace(0, 1, 7), 3, 2)
    dot = lambda a, b: np.einsum("ij,ij->i", c[a], c[b])  # noqa: E731
    assert dot(0, 0) == pytest.approx(1, abs=1e-14)
    assert dot(0, 1) == pytest.approx(0, abs=1e-14)
    assert dot(0, 2) + dot(1, 1) == pytest.approx(0, abs=1e-13)
    assert dot(0, 3) + 3 * dot(1, 2) == pytest.approx(0, abs=1e-12)


# |x| from -1 to 1: a kink at 0
KINK = np.array([-1.0, -1.0, 0.0, 1.0, 1.0])
KINK_CONTROL = np.array([[1.0], [0.0], [1.0]])


@pytest.mark.parametrize(
    "first, last, at, slope",
    [
        (-1, 1, 0.0, 1.0),  # inside: that of the span which begins there
        (-1, 0, 0.0, -1.0),
        (0, 1, 0.0, 1.0),
        (-1, 0, 1e-14, -1.0),  # an end within round-off of the knot
        (0, 1, -1e-14, 1.0),
        (-1, 0, 0.1, 1.0),  # beyond the end: where it lies
        (np.nan, np.nan, 0.0, 1.0),
    ],
)
def test_at_a_kink_derivatives_are_those_inside(first, last, at, slope):
    assert curve(KINK, KINK_CONTROL, at, 1, 1, (first, last, 0.0))[1] == slope


@pytest.mark.parametrize(
    "first, last, at, slope",
    [
        (-1, 1, 1.0, 1.0),
        (-1, 1, -1.0, -1.0),
        (1, 3, 1.0, -1.0),
        (-3, -1, -1.0, 1.0),
        (2, 3, 2.0, 1.0),
        (1, 2, 2.0, -1.0),
        (-2, -1, -1.0, 1.0),
        (-1, 1, 4.25, 1.0),
    ],
)
def test_at_a_kink_in_the_seam_too(first, last, at, slope):
    # the kinks of the zigzag of period 2 lie at all whole numbers
    value, found = curve(KINK, KINK_CONTROL, at, 1, 1, (first, last, 2.0))
    assert found == slope
    assert value == pytest.approx(abs((at + 1) % 2 - 1))


def test_beyond_the_ends_the_polynomial_goes_on():
    knots = np.array([0, 0, 0, 0.5, 1, 1, 1.0])
    control = np.array([[0], [0], [0.5], [1.0]])
    inside = curve(knots, control, [0.6, 0.8, 0.9], 2, 1)[:, :, 0]
    parabola = np.polynomial.Polynomial.fit([0.6, 0.8, 0.9], inside[0], 2)
    outside = curve(knots, control, [1.0, 1.7], 2, 1)[:, :, 0]
    assert outside[0] == pytest.approx(parabola(np.array([1.0, 1.7])))
    assert outside[1] == pytest.approx(parabola.deriv()(np.array([1.0, 1.7])))


def test_empty_spans_at_the_ends_are_passed_over():
    knots = np.array([0, 0, 0, 0, 1, 2, 2, 2, 2.0])  # degree 2 with a knot too many at each end
    assert basis(knots, 2, -0.5, 0, (np.nan, np.nan, 0.0))[:2] == (3, -0.5)
    assert basis(knots, 2, 2.0, 0, (np.nan, np.nan, 0.0))[:2] == (4, 2.0)
    assert basis(knots, 2, 2.0, 0, (0.0, 2.0, 0.0))[:2] == (4, 2.0)
    assert basis(knots, 2, 0.0, 0, (0.0, 2.0, 0.0))[:2] == (3, 0.0)


@pytest.mark.parametrize(
    "knots, count",
    [
        ([0, 0, 1, 1], 1),  # fewer points than a degree has
        ([0, 0, 1, 1], 3),  # too few knots
        ([0, 0, 1, 0.5, 1], 3),
        ([0, 0, np.nan, 1, 1], 3),
        ([0, 0, 0, 0, 0], 3),
    ],
)
def test_splines_that_are_none_are_refused(knots, count):
    with pytest.raises(ValueError, match="knots"):
        surfaces.spline_curve(np.array(knots, float), np.zeros((count, 3)), None, None, 0.0)


def test_weights_of_another_number_are_refused():
    knots = np.array([0.0, 0.0, 1.0, 1.0])
    with pytest.raises(ValueError, match="weights"):
        surfaces.spline_curve(knots, np.zeros((2, 3)), np.ones(3), None, 0.0)
    domain = (0.0, 1.0), (0.0, 1.0)
    with pytest.raises(ValueError, match="weight"):
        surfaces.spline_surface(
            domain, knots, knots, np.zeros((2, 2, 3)), np.ones((2, 3)), (0.0, 0.0)
        )


@settings(deadline=None, max_examples=20)
@given(st.integers(1, 5), st.integers(1, 5), st.booleans(), st.integers(0, 10_000))
def test_points_of_a_block_are_those_of_each_alone(degree_u, degree_v, rational, seed):
    """Two that follow each other are computed at once where they lie in one span."""
    rng = np.random.default_rng(seed)
    knots = [random_knots(rng, degree, 3) for degree in (degree_u, degree_v)]
    shape = [len(one) - degree - 1 for one, degree in zip(knots, (degree_u, degree_v))]
    control = rng.uniform(0.5, 1.0, (*shape, 4 if rational else 3))
    uv = rng.choice(rng.uniform(0.0, 1.0, 12), (40, 2))  # some parameters again and again
    for order in range(4):
        whole = surface(*knots, control, uv, order)
        alone = [surface(*knots, control, uv[k : k + 1], order) for k in range(len(uv))]
        for number, values in enumerate(whole):
            np.testing.assert_array_equal(values, np.concatenate([one[number] for one in alone]))
