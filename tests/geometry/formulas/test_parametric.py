"""Surfaces from formulas: refusals with the reason, derivatives, degenerate places."""

import pickle
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest

from surfmesh.errors import FormulaError, SurfaceError
from surfmesh.geometry.files.formula_file import gallery, load_formula_file
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.surface import Surface

UNIT = {"u": (0, 1), "v": (0, 1)}

REFUSED = [
    (("u", "v", "0"), {"u": (0, 0), "v": (0, 1)}, "domain of u is empty"),
    (("u", "v", "0"), {"u": (0, 1), "v": ("pi", "-pi")}, "domain of v is reversed"),
    (("u", "v", "0"), {"u": (0, float("inf")), "v": (0, 1)}, "domain of u: a finite number"),
    (("u", "v", "0"), {"u": (0, float("nan")), "v": (0, 1)}, "domain of u: a finite number"),
    (("u", "v", "0"), {"u": 3, "v": (0, 1)}, "pair"),
    (("u", "v", "1/(u - 1/3)"), UNIT, r"z = 1/\(u - 1/3\) .* \(0.333333, 0\)"),
    (("u", "tan(3*u)", "v"), UNIT, r"y = .* \(0.523599, 0\)"),
    (("u", "v", "1/(u - v + 0.0012345)"), UNIT, "z = .* not a finite real number"),
    (("log(u)", "v", "0"), UNIT, r"x = .* \(0, 0\)"),
    (("u", "v", "sqrt(u**2 + v**2 - 0.1)"), UNIT, "z = .* not a finite real number"),
    (("u", "v", "exp(1000*u)"), UNIT, "z = .* not a finite real number"),
    (("u", "v", "sin(u)/u"), UNIT, r"z = .* \(0, 0\)"),
    (("u + v", "2*(u + v)", "sin(u + v)"), UNIT, "no area"),
    (("u", "u**2", "u**3"), UNIT, "no area"),
    (("1", "2", "pi"), UNIT, "single point"),
    (("u", "v", "w"), UNIT, "z: unknown name 'w'"),
    (("u", "v", "0"), UNIT | {"parameters": {"sin": 1.0}}, "known already"),
    (("u", "v", "0"), UNIT | {"parameters": {"a b": 1.0}}, "cannot name"),
    (("u", "v", "0"), UNIT | {"parameters": {"a": float("nan")}}, "not finite"),
    (("u", "v", "0"), UNIT | {"parameters": {"a": "1"}}, "not a number"),
    (("u", "v", "0"), UNIT | {"loops": [[(0, 0), (1, 1)]]}, "loop 0"),
]


@pytest.mark.parametrize("formulas, rest, reason", REFUSED, ids=lambda x: str(x)[:30])
def test_refused_with_the_reason(formulas, rest, reason):
    with pytest.raises(SurfaceError, match=reason):
        ParametricSurface(*formulas, **rest)


ACCEPTED = [
    ("u", "v", "0"),
    ("u", "v", "u**v"),  # 0**0 is 1
    ("u", "v", "sqrt(u)*sqrt(1 - v)"),
    ("u", "v", "1/(u**2 - u + 1/4 + 1e-7)"),  # a spike that interval bounds see as a pole first
    ("u", "v", "atan2(v - 1/2, u - 1/2)"),
    ("u", "v", "1/(1.001 - cos(7*u)*sin(5*v))"),
    ("u*cos(2*pi*v)", "u*sin(2*pi*v)", "u"),
    ("u*v", "u", "v**2"),
]


@pytest.mark.parametrize("formulas", ACCEPTED, ids=str)
def test_difficult_but_finite_surfaces_are_accepted(formulas):
    surface = ParametricSurface(*formulas, **UNIT)
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, 21)] * 2), axis=-1).reshape(-1, 2)
    assert all(np.isfinite(value).all() for value in surface.evaluate(grid, 2))


def test_the_error_keeps_the_column():
    with pytest.raises(FormulaError) as caught:
        ParametricSurface("u", "v + u.real", "0", **UNIT)
    assert (caught.value.column, caught.value.text) == (6, "v + u.real")
    assert caught.value.reason.startswith("y: ")


def test_derivatives_at_an_apex_are_finite():
    cone = ParametricSurface("u", "v", "sqrt(u**2 + v**2)", u=(-1, 1), v=(-1, 1))
    r, r_u, r_v, *second = cone.evaluate([[0, 0], [0.6, 0.8]], 2)
    assert r[0].tolist() == [0, 0, 0]
    assert np.isfinite([r_u, r_v, *second]).all()
    assert np.hypot(r_u[0, 2], r_v[0, 2]) == pytest.approx(1)
    assert r_u[1] == pytest.approx([1, 0, 0.6])


@pytest.mark.parametrize("name", gallery())
def test_derivatives_agree_with_central_differences(name):
    surface = load_formula_file(gallery()[name])
    lo, hi = np.array(surface.domain).T
    uv = lo + (hi - lo) * np.random.default_rng(3).uniform(0.05, 0.95, (50, 2))
    _, r_u, r_v, r_uu, r_uv, r_vv = surface.evaluate(uv, 2)
    h = 1e-5 * (hi - lo)
    for axis, first, (along_u, along_v) in ((0, r_u, (r_uu, r_uv)), (1, r_v, (r_uv, r_vv))):
        move = np.eye(2)[axis] * h
        ahead, behind = surface.evaluate(uv + move, 1), surface.evaluate(uv - move, 1)
        pairs = zip((first, along_u, along_v), ahead, behind)
        for exact, after, before in pairs:
            slope = (after - before) / (2 * h[axis])
            scale = np.abs(exact).max() + np.abs(after).max()
            assert np.abs(exact - slope).max() < 1e-6 * scale


@pytest.mark.parametrize("name", gallery())
def test_derivative_bounds_hold_samples(name):
    surface = load_formula_file(gallery()[name])
    (u0, u1), (v0, v1) = surface.domain
    rng = np.random.default_rng(5)
    lo = [u0, v0] + rng.uniform(0, 0.9, (40, 2)) * [u1 - u0, v1 - v0]
    hi = lo + rng.uniform(0, 0.1, (40, 2)) * [u1 - u0, v1 - v0]
    lower, upper = surface.derivative_bounds(lo, hi)
    assert lower.shape == upper.shape == (40, 5, 3)
    for fraction in rng.uniform(0, 1, (20, 2)):
        values = np.stack(surface.evaluate(lo + fraction * (hi - lo), 2)[1:], axis=1)
        slack = 1e-12 * np.abs(values).max()
        assert (lower - slack <= values).all() and (values <= upper + slack).all()


def test_orders_agree():
    surface = load_formula_file(gallery()["klein"])
    uv = np.random.default_rng(0).uniform(0, 6, (100, 2))
    values = [surface.evaluate(uv, order) for order in range(3)]
    assert [len(v) for v in values] == [1, 3, 6]
    for few, more in pairwise(values):
        for a, b in zip(few, more):
            assert a == pytest.approx(b, rel=1e-14, abs=1e-13)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_size_and_order_of_parameters_do_not_matter(scale):
    plain = load_formula_file(gallery()["two_peaks"])
    x, y, z = (f"s*({formula})" for formula in plain.formulas)
    swap = {ord("u"): "v", ord("v"): "u"}
    swapped = [f.translate(swap) for f in (x, y, z)]
    bounds = {"u": (-3, 3), "v": (-3, 3), "parameters": {"s": scale}}
    large, turned = ParametricSurface(x, y, z, **bounds), ParametricSurface(*swapped, **bounds)
    uv = np.random.default_rng(2).uniform(-3, 3, (200, 2))
    expected = plain.evaluate(uv, 2)
    for a, b in zip(expected, large.evaluate(uv, 2)):
        assert np.allclose(b, scale * a, rtol=1e-12, atol=1e-12 * scale)
    order = (0, 2, 1, 5, 4, 3)  # r_u and r_v, r_uu and r_vv change places
    for a, place in zip(expected, order):
        b = turned.evaluate(uv[:, ::-1], 2)[place]
        assert np.allclose(b, scale * a, rtol=1e-12, atol=1e-12 * scale)


def test_a_surface_does_not_change_and_says_what_it_is():
    surface = ParametricSurface("a*u", "v", 0, u=(0, "2*pi"), v=(0, 1), parameters={"a": 2})
    with pytest.raises(AttributeError):
        surface.name = "other"
    assert repr(surface) == (
        "ParametricSurface('surface', x='a*u', y='v', z='0', u=(0, 6.28319), v=(0, 1), a=2)"
    )
    assert isinstance(surface, Surface)


def test_a_pickled_surface_needs_no_sympy():
    surface = load_formula_file(gallery()["torus"])
    program = (
        "import pickle, sys; surface = pickle.load(sys.stdin.buffer); "
        "r = surface.evaluate([[0.0, 0.0]], 2); surface.derivative_bounds([[0, 0]], [[1, 1]]); "
        "print(r[0][0, 0], 'sympy' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        input=pickle.dumps(surface),
        capture_output=True,
        check=True,
    )
    assert done.stdout.split() == [b"4.0", b"False"]
