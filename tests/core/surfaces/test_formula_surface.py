"""Surfaces of formulas in the core: their tapes, and what they do where derivatives break off."""

import pickle

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core import surfaces
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.infinite_speed import is_bent, kept_off

PI = np.pi
NONE = ([], [], [])
SURFACES = {
    "torus": sm.ParametricSurface(
        "(3 + cos(v))*cos(u)", "(3 + cos(v))*sin(u)", "sin(v)", (0, 2 * PI), (0, 2 * PI)
    ),
    "cone": sm.ParametricSurface("u", "v", "sqrt(u**2 + v**2)", (-1, 1), (-1, 1)),
    "dome": sm.ParametricSurface("u", "v", "sqrt(1 - u**2)*(1 + v)", (-1, 1), (0, 1)),
    "creased": sm.ParametricSurface("u", "v", "abs(u - 0.3)", (0, 1), (0, 1)),
}
by_surface = pytest.mark.parametrize("surface", SURFACES.values(), ids=SURFACES)


def points(surface, count=700):
    (u0, u1), (v0, v1) = surface.domain
    uv = np.random.default_rng(1).uniform((u0, v0), (u1, v1), (count, 2))
    corners = [(u0, v0), (u1, v1), (u0, v1), (0.0, 0.0)]
    return np.concatenate([uv, corners])


def slow(surface, uv, order):
    """The same in numpy, from the tape."""
    tape = surface.tape(order)
    r, *rest = (value.copy() for value in tape.evaluate(uv))
    if order == 0:
        return [r]
    lo, hi = np.array(surface.domain).T
    clear = kept_off(surface.bent_axes, uv) if is_bent(surface.bent_axes) else uv
    rest = list(tape.evaluate(clear)[1:]) if is_bent(surface.bent_axes) else rest
    towards = np.where(clear > 0.5 * (lo + hi), -1.0, 1.0)
    for nudge in (1e-9, 1e-6):
        broken = ~np.all([np.isfinite(value).all(axis=1) for value in rest], axis=0)
        inside = tape.evaluate((clear + towards * nudge * (hi - lo))[broken])
        for value, better in zip(rest, inside[1:]):
            value[broken] = better
    return [r, *rest]


@by_surface
@pytest.mark.parametrize("order", [0, 1, 2])
def test_values_are_those_of_the_tapes_mended_where_they_break_off(surface, order):
    uv = points(surface)
    for found, expected in zip(surface.evaluate(uv, order), slow(surface, uv, order), strict=True):
        assert np.array_equal(found, expected)
        assert np.isfinite(found).all()
    assert np.array_equal(surface.core.evaluate(uv, order), surface.evaluate(uv, order))


@by_surface
def test_bounds_hold_the_derivatives(surface):
    rng = np.random.default_rng(2)
    (u0, u1), (v0, v1) = surface.domain
    lo = rng.uniform((u0, v0), (u1, v1), (300, 2))
    hi = np.minimum(lo + rng.uniform(0.0, 0.2, (300, 2)), (u1, v1))
    lower, upper = surface.derivative_bounds(lo, hi)
    assert lower.shape == upper.shape == (300, 5, 3)
    again = surface.tape(2).bounds(lo, hi, kinks=False)
    assert np.array_equal(lower.reshape(300, 15), again[0][:, 3:])
    assert np.array_equal(upper.reshape(300, 15), again[1][:, 3:])
    for t in rng.uniform(0.0, 1.0, 5):
        values = np.stack(surface.tape(2).evaluate(lo + t * (hi - lo))[1:], axis=1)
        assert ((lower <= values) & (values <= upper) | ~np.isfinite(values)).all()


@by_surface
def test_the_core_has_the_same_surface_after_a_journey(surface):
    other = pickle.loads(pickle.dumps(surface))
    uv = points(surface, 50)
    assert as_core_surface(other) is other.core
    assert np.array_equal(other.core.evaluate(uv, 2), surface.core.evaluate(uv, 2))
    assert other.core.domain == surface.domain


def test_a_smaller_domain_is_nudged_into_itself():
    cone = SURFACES["cone"].with_domain(((0.0, 1.0), (0.0, 0.5)))
    assert cone.core.domain == ((0.0, 1.0), (0.0, 0.5))
    _, r_u, r_v = cone.evaluate(np.array([[0.0, 0.0]]), 1)  # a billionth of the domain inside
    assert r_u[0] == pytest.approx([1.0, 0.0, 2.0 / np.sqrt(5.0)])
    assert r_v[0] == pytest.approx([0.0, 1.0, 1.0 / np.sqrt(5.0)])


def test_wrong_arguments_are_refused():
    torus = SURFACES["torus"]
    tapes = [torus.tape(order).program for order in range(3)]
    domain = ((0.0, 1.0), (0.0, 1.0))
    only_values = surfaces.FormulaSurface([tapes[0], None, None], domain, (NONE, NONE))
    assert only_values.evaluate(np.zeros((1, 2)), 0).shape == (1, 1, 3)
    assert only_values.derivative_bounds(np.zeros((1, 2)), np.ones((1, 2))) is None
    with pytest.raises(ValueError, match="order"):
        only_values.evaluate(np.zeros((1, 2)), 1)
    with pytest.raises(ValueError, match="order"):
        torus.core.evaluate(np.zeros((1, 2)), 3)
    for wrong in ([], tapes[:2], [tapes[1], tapes[0], tapes[2]]):
        with pytest.raises(ValueError, match="tape"):
            surfaces.FormulaSurface(wrong, domain, (NONE, NONE))
    with pytest.raises(ValueError, match="limits"):
        surfaces.FormulaSurface(tapes, domain, (([0.0, 1.0], [0.0], []), NONE))
