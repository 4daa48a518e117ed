"""Tapes against slow twins: one node at a time in 30 digits, and samples inside every interval."""

import pickle
from dataclasses import replace

import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core import elementary_functions, surfaces
from surfmesh.geometry.formulas.compilation import (
    by_definitions,
    compiled,
    long_surface_tape,
    surface_tape,
)
from surfmesh.geometry.formulas.expression import parse
from surfmesh.geometry.formulas.parser import symbol
from surfmesh.geometry.formulas.tape import result_of

U, V = VARIABLES = symbol("u"), symbol("v")
ORDERS = ((), (U,), (V,), (U, U), (U, V), (V, V))

_leaf = st.sampled_from(["u", "v", "2", "0.3", "pi"])


def _grown(inner):
    one = st.sampled_from(
        ["sin", "cos", "tan", "exp", "atan", "tanh", "sqrt", "log", "cosh", "asinh", "abs", "cbrt"]
    )
    return st.one_of(
        st.builds("({} {} {})".format, inner, st.sampled_from("+-*/"), inner),
        st.builds("{}({})".format, one, inner),
        st.builds("({})**{}".format, inner, st.sampled_from(["2", "3", "4", "-1", "0.5", "1.5"])),
        st.builds("{}({}, {})".format, st.sampled_from(["min", "max", "atan2"]), inner, inner),
    )


formulas = st.recursive(_leaf, _grown, max_leaves=8)


def _parsed(text):
    try:
        return parse(text)
    except ValueError:  # a constant part that is not finite
        return sp.Integer(1)


@given(st.tuples(formulas, formulas, formulas))
@settings(max_examples=60, deadline=None, derandomize=True)
def test_values_and_derivatives_agree_with_the_slow_twin(texts):
    coordinates = [_parsed(text) for text in texts]
    tapes = surface_tape(coordinates, VARIABLES, 2), long_surface_tape(coordinates, VARIABLES, 2)
    mpmath.mp.dps = 30
    point = (0.371, 0.823)
    results = []
    for tape in tapes:
        assert tape.broken_invariant() == ""
        results.append(tape.evaluate(np.array([point])))
    for number, order in enumerate(ORDERS):
        for axis, coordinate in enumerate(coordinates):
            derivative = sp.diff(coordinate, *order) if order else coordinate
            expected = _slow_value(derivative, point)
            if expected is not None and abs(expected) < 1e8:
                for result in results:
                    found = result[number][0, axis]
                    assert found == pytest.approx(expected, rel=1e-8, abs=1e-8)


NAIVE = {
    "absolute": abs,
    "side": mpmath.sign,
    "kink": lambda x: mpmath.mpf(0),
    "jump": lambda x: mpmath.mpf(0),
    "cut": lambda y, x: mpmath.mpf(0),
    "turn": mpmath.atan2,
    "signum": mpmath.sign,
    "step": lambda x: (1 + mpmath.sign(x)) / 2,
    "minimum": min,
    "maximum": max,
    "cube_root": lambda x: mpmath.sign(x) * mpmath.cbrt(abs(x)),
    "angle": mpmath.atan2,
}


def _slow_value(expression, point):
    """The twin: one node at a time in 30 digits; None where it is not finite or not real."""
    values = {U: mpmath.mpf(point[0]), V: mpmath.mpf(point[1])}
    for node in sp.postorder_traversal(expression):
        if node in values:
            continue
        arguments = [values[part] for part in node.args]
        try:
            if node.is_Rational:
                value = mpmath.mpf(int(node.p)) / int(node.q)
            elif node.is_NumberSymbol:
                value = {sp.pi: +mpmath.pi, sp.E: mpmath.e + 0}[node]
            elif node.is_Add:
                value = mpmath.fsum(arguments)
            elif node.is_Mul:
                value = mpmath.fprod(arguments)
            elif node.is_Pow:
                value = mpmath.power(*arguments)
            else:
                name = node.func.__name__
                value = (NAIVE.get(name) or getattr(mpmath, name))(*arguments)
        except (ZeroDivisionError, OverflowError, ValueError):
            return None
        if not isinstance(value, mpmath.mpf) or not abs(value) < 1e12:
            return None
        values[node] = value
    return float(values[expression])


# in hundredths: a tiny number that a sum swallows is round-off, which bounds leave out
_corner, _size = st.integers(-200, 200), st.integers(0, 150)


@given(formulas, st.tuples(_corner, _corner), st.tuples(_size, _size))
@settings(max_examples=150, deadline=None, derandomize=True)
def test_bounds_hold_every_sample(text, corner, size):
    tape = surface_tape([_parsed(text), U, V], VARIABLES, 2)
    lo = np.array([corner]) / 100
    hi = lo + np.array([size]) / 100
    lower, upper = tape.bounds(lo, hi)
    fraction = np.linspace(1e-9, 1 - 1e-9, 13)  # at its ends a slope is that of the inside
    grid = np.stack(np.meshgrid(fraction, fraction), axis=-1).reshape(-1, 2)
    values = np.hstack(tape.evaluate(lo + grid * (hi - lo)))
    defined = np.isfinite(values)
    assert not np.isnan(lower).any() and not np.isnan(upper).any()
    slack = 1e-9 * (1 + np.abs(np.where(defined, values, 0)))
    assert ((values >= lower - slack) | ~defined).all()
    assert ((values <= upper + slack) | ~defined).all()


@pytest.mark.parametrize(
    "text, low, high",
    [
        ("sin(u)", -1, 1),
        ("cos(u)", np.cos(2), 1),
        ("u**2", 0, 4),
        ("u**3", -1, 8),
        ("abs(u)", 0, 2),
        ("sqrt(u + 1)", 0, np.sqrt(3)),
        ("exp(u)", np.exp(-1), np.exp(2)),
        ("1/(u + 2)", 0.25, 1),
        ("1/u", -np.inf, np.inf),
        ("log(u)", -np.inf, np.log(2)),
        ("tan(u)", -np.inf, np.inf),
        ("atan2(u, -v)", -np.pi, np.pi),
        ("min(u, v)", -1, 2),
        ("(v - 2)**v", 0, 1),
    ],
)
def test_bounds_are_tight_where_a_variable_stands_once(text, low, high):
    box_lo, box_hi = [[-1, 2]], [[2, 3]]
    if text == "sin(u)":
        box_lo, box_hi = [[-2, 2]], [[2, 3]]
    tape = compiled([parse(text)], VARIABLES)
    lower, upper = tape.bounds(np.array(box_lo), np.array(box_hi))
    assert lower[0, 0] == pytest.approx(low, rel=1e-12, abs=1e-12)
    assert upper[0, 0] == pytest.approx(high, rel=1e-12, abs=1e-12)


def test_bounds_close_in_at_first_order():
    """Halving a cell at least halves the excess: what proves that nothing hides in it."""
    tape = compiled([parse("(u + 3*v)**2 * exp(1 - u**2 - v**2)")], VARIABLES)
    widths = []
    for size in (0.1, 0.05, 0.025):
        lower, upper = tape.bounds(np.array([[0.4, 0.6]]), np.array([[0.4 + size, 0.6 + size]]))
        widths.append(upper[0, 0] - lower[0, 0])
    assert widths[1] < 0.55 * widths[0] and widths[2] < 0.55 * widths[1]


@pytest.mark.parametrize("n", range(2, 65))
def test_integer_powers(n):
    for x in np.linspace(-1.5, 1.5, 31).tolist():
        assert result_of("integer_power", [x], n) == pytest.approx(x**n, rel=1e-13)


def test_blocks_do_not_show():
    tape = surface_tape([parse("u*v"), parse("sin(u)"), parse("3")], VARIABLES, 1)
    points = np.random.default_rng(1).uniform(-1, 1, (2 * surfaces.BLOCK + 17, 2))
    r, r_u, r_v = tape.evaluate(points)
    assert np.array_equal(r[:, 0], points[:, 0] * points[:, 1])
    assert np.array_equal(r[:, 1], elementary_functions.sin(points[:, 0]))
    assert np.array_equal(r[:, 2], np.full(len(points), 3.0))
    assert np.array_equal(r_u[:, 0], points[:, 1]) and not r_v[:, 1:].any()
    assert all(array.flags.c_contiguous for array in (r, r_u, r_v))
    assert [len(a) for a in tape.evaluate(np.empty((0, 2)))] == [0, 0, 0]


def test_shared_subexpressions_are_computed_once():
    tape = surface_tape([parse("exp(u*v)"), parse("exp(u*v) + 1"), parse("sin(u)")], VARIABLES, 2)
    operations = [step.operation for step in tape.instructions]
    assert operations.count("exp") == 1
    assert operations.count("sin") == 1


def test_a_long_product_is_differentiated_in_time_linear_in_its_length():
    text = "*".join(f"(1 + u/{i} + v)" for i in range(2, 80))
    tape = surface_tape([parse(text), U, V], VARIABLES, 2)
    assert len(tape.instructions) < 80 * 25
    r, r_u = tape.evaluate(np.array([[0.01, 0.002]]))[:2]
    factors = [1 + 0.01 / i + 0.002 for i in range(2, 80)]
    assert r[0, 0] == pytest.approx(np.prod(factors), rel=1e-12)
    slope = np.prod(factors) * sum(1 / i / f for i, f in zip(range(2, 80), factors))
    assert r_u[0, 0] == pytest.approx(slope, rel=1e-12)


EVERY_FUNCTION = (
    "sin(u*v) + cos(u/v) - tan(u) + asin(u*v/2) + acos(u/2) + atan(u*v) + atan2(u, v - 2)",
    "sinh(u*v) * cosh(u) + tanh(v) + asinh(u*v) + acosh(2 + u*v) + atanh(u*v/2) + erf(u*v)",
    "exp(u*v) / log(2 + u*v) + sqrt(1 + u*v) + cbrt(u*v) + sinc(3*u*v) + (u*v)**0.3 + u**v",
    "(u + v)**-3 + (u + v)**7 + (1 + u*v)**(u - v) + 2**(u*v) + cos(2*atan2(v, u))",
    "abs(u - v) + sign(u) * v + heaviside(v - u) * u**2 + floor(3*u*v) + min(u, v, u*v)",
    "max(u - v, u*v) * min(u**2, v) + abs(sin(9*u*v))**1.5 + abs(max(u, v) - 0.5)",
)


@pytest.mark.parametrize("text", EVERY_FUNCTION)
def test_programs_are_differentiated_as_expressions_are(text):
    """Two ways to the same derivatives and bounds: SymPy's, and one step at a time."""
    coordinates = [parse(text), parse(f"({text})**2"), parse(f"exp(-abs({text}))")]
    places = 0.05 + 0.9 * np.random.default_rng(13).random((200, 2))
    by_sympy, by_steps = (
        differentiated(coordinates, VARIABLES, 2).evaluate(places)
        for differentiated in (by_definitions, long_surface_tape)
    )
    for one, other in zip(by_sympy, by_steps):
        scale = 1.0 + np.abs(one).max()
        assert np.allclose(one, other, rtol=1e-9, atol=1e-11 * scale)
    lower, upper = long_surface_tape(coordinates, VARIABLES, 2).bounds(places - 1e-6, places + 1e-6)
    values = np.hstack(by_steps)
    assert ((lower <= values) & (values <= upper)).all()


def test_a_piecewise_choice_is_differentiated_behind_the_choice():
    chosen = parse(sp.Piecewise((sp.log(U) * V, U > 0), (U**2 * V, True)))
    tape = long_surface_tape([chosen, U, V], VARIABLES, 2)
    (r_u, r_v) = tape.evaluate(np.array([[0.5, 2.0], [-0.5, 2.0]]))[1:3]
    assert r_u[:, 0] == pytest.approx([4.0, -2.0])
    assert r_v[:, 0] == pytest.approx([np.log(0.5), 0.25])


def test_three_hundred_sines_are_few_steps():
    """Differentiated as one expression they took a quarter of a minute."""
    text = "+".join(f"sin({k}*u+{k % 7}*v)*cos({k % 5}*v)" for k in range(1, 301))
    tape = surface_tape([U, V, parse(text)], VARIABLES, 2)
    assert len(tape.instructions) < 300 * 30
    at = np.array([[0.3, 0.4]])
    slope = sum(k * np.cos(0.3 * k + 0.4 * (k % 7)) * np.cos(0.4 * (k % 5)) for k in range(1, 301))
    assert tape.evaluate(at)[1][0, 2] == pytest.approx(slope, rel=1e-9)


def test_tapes_can_be_pickled_and_broken_ones_are_noticed():
    tape = surface_tape([parse("sin(cos(u))"), parse("v"), parse("u + v")], VARIABLES, 2)
    assert pickle.loads(pickle.dumps(tape)) == tape
    assert (
        "before it is written"
        in replace(tape, instructions=tape.instructions[1:]).broken_invariant()
    )
    assert "never written" in replace(tape, instructions=()).broken_invariant()
    assert "outside the registers" in replace(tape, registers=0).broken_invariant()
