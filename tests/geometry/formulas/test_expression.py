"""Formulas are data: what is accepted means what mathematics says, the rest is refused."""

import math
import sys

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh.errors import FormulaError, SurfaceError
from surfmesh.geometry.formulas.compilation import compiled, surface_tape
from surfmesh.geometry.formulas.expression import parse, parse_number
from surfmesh.geometry.formulas.function_table import FUNCTIONS
from surfmesh.geometry.formulas.parser import symbol

U, V = symbol("u"), symbol("v")

# formula, column that the message points at, a word of the reason
HOSTILE = [
    ("__import__('os')", 12, "quotes"),
    ("__import__(u)", 1, "not a known function"),
    ("u.__class__", 2, "attribute"),
    ("(u).real", 4, "attribute"),
    ("1..real", 3, "attribute"),
    ("1.__class__", 3, "operator is missing"),
    ("lambda: 0", 7, "':'"),
    ("(lambda x: x)(u)", 10, "':'"),
    ('exec("")', 6, "quotes"),
    ("f'{u}'", 2, "quotes"),
    ("9**9**9**9", 7, "exponent"),
    ("u**-65", 4, "exponent"),
    ("u**1e9", 4, "exponent"),
    ("(u**9)**9", 7, "exponent"),
    ("10**400", 5, "exponent"),
    ("((((1+1/10**60)**60)**60)**60)**60", 18, "digits"),
    ("((10**60)**60)", 3, "too large"),
    ("exp(exp(exp(1000)))", 9, "too large"),
    ("u + exp(1000 + v - v)", 5, "too large"),
    ("9" * 400, 1, "too large"),
    ("1e400", 1, "too large"),
    ("(" * 1000, 65, "nested"),
    ("-" * 100 + "u", 65, "nested"),
    ("sin(" * 100 + "u" + ")" * 100, 260, "nested"),
    ("u+" * 6000 + "u", 10_001, "longer"),
    ("u if v else 0", 3, "operator is missing"),
    ("[u]", 1, "brackets"),
    ("{u}", 1, "braces"),
    ("u;v", 2, "';'"),
    ("u,v", 2, "comma"),
    ("(u,v)", 3, "comma"),
    ("u := 1", 3, "':'"),
    ("u = 1", 3, "comparison"),
    ("u < v", 3, "comparison"),
    ("u != v", 3, "comparison"),
    ("u // v", 4, "value is expected"),
    ("u %v", 3, "'%'"),
    ("u\\v", 2, "not part"),
    ("u\0", 2, "not part"),
    ("u − v", 3, "minus sign"),
    ("ｕ", 1, "fullwidth"),
    ("2·u", 2, "middle dot"),
    ("", 1, "empty"),
    ("   ", 1, "empty"),
    ("u +", 4, "ends where a value"),
    ("* u", 1, "value is expected"),
    ("u * (v", 5, "never closed"),
    ("cos(u", 4, "never closed"),
    ("u)", 2, "never opened"),
    ("sin", 1, "is a function"),
    ("sin u", 1, "is a function"),
    ("sin()", 1, "1 argument, not 0"),
    ("sin(u, v)", 1, "1 argument, not 2"),
    ("1 + atan2(u)", 5, "2 arguments, not 1"),
    ("max(u)", 1, "2 to 16"),
    ("foo(u)", 1, "not a known function"),
    ("u + w", 5, "unknown name"),
    ("u(3)", 1, "not a function"),
    ("pi(3)", 1, "not a function"),
    ("2u", 2, "operator is missing"),
    ("(u)(v)", 4, "operator is missing"),
    ("1/0", 3, "division by zero"),
    ("u/(v - v)", 4, "division by zero"),
    ("0**-1", 1, "finite real"),
    ("atan(sin(pi)**-1)", 6, "finite real"),
    ("tan(pi/2)", 1, "finite real"),
    ("(u - u)**-1", 2, "finite real"),
    ("sqrt(-1)", 1, "finite real"),
    ("u*log(0)", 3, "finite real"),
    ("(-8)**(1/3)", 2, "finite real"),
    ("asin(2)", 1, "finite real"),
    ("sqrt(-u**2)", 1, "finite real"),
]


@pytest.mark.parametrize("text, column, reason", HOSTILE, ids=lambda x: str(x)[:20])
def test_refused_at_the_right_column(text, column, reason):
    with pytest.raises(FormulaError) as caught:
        parse(text)
    assert (caught.value.column, caught.value.text) == (column, text)
    assert reason in caught.value.reason


MEANING = [
    ("-u**2", -(U**2)),
    ("(-u)^2", U**2),
    ("2^3^2/512", sp.Integer(1)),
    ("u - v - 1", U - V - 1),
    ("u/v/2", U / V / 2),
    ("2**-1", sp.Rational(1, 2)),
    ("- -u", U),
    ("0.1*u", U / 10),
    ("1.5e-3*u", 3 * U / 2000),
    (".5*u + 2.", U / 2 + 2),
    ("u**0.5", sp.sqrt(U)),
    ("e**u + ln(v)", sp.exp(U) + sp.log(V)),
    ("tau - 2*pi", sp.Integer(0)),
    ("sec(u)*cos(u) + cot(u)*tan(u)", 1 + sp.cos(U) * sp.tan(U) / sp.sin(U)),
    ("u\n + v", U + V),
    ("a*u + n", sp.Rational(1, 10) * U + 3),
    (2, sp.Integer(2)),
    (0.25, sp.Rational(1, 4)),
]


@pytest.mark.parametrize("text, meaning", MEANING, ids=lambda x: repr(x)[:20])
def test_means_what_mathematics_says(text, meaning):
    assert parse(text, parameters={"a": 0.1, "n": 3}) == meaning


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_every_function_has_its_value_and_its_derivative(name):
    function = FUNCTIONS[name]
    places = np.array([[0.31, 0.72], [0.62, 0.15]])
    if name in ("acosh", "arccosh", "acoth", "asec", "acsc"):
        places = places + 1.5
    arguments = ["u", "v"][: function.fewest]
    expression = parse(f"{name}({', '.join(arguments)})")
    values = _values(expression, places)
    expected = [function.value(*place[: function.fewest]) for place in places.tolist()]
    assert values == pytest.approx(expected, rel=1e-14)

    h = 1e-6
    ahead, behind = _values(expression, places + [h, 0]), _values(expression, places - [h, 0])
    slope = _values(sp.diff(expression, U), places)
    assert slope == pytest.approx((ahead - behind) / (2 * h), rel=1e-7, abs=1e-9)


def calls_of(function):
    """How many functions are called by ``function``, of Python and of C."""
    count = 0

    def heard(frame, event, argument):
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(heard)
    try:
        function()
    finally:
        sys.setprofile(before)
    return count


def test_long_formulas_take_work_in_proportion():
    def terms(first, many):
        return "+".join(f"sin(u + {i}*v)" for i in range(first, first + many))

    parse(terms(1, 50))  # what is kept for ever is made
    short, long = (calls_of(lambda n=n: parse(terms(10 * n, n))) for n in (50, 400))
    assert long < 10 * short


def test_expressions_that_are_already_built():
    u, v, a = sp.symbols("u v a")  # not known to be real: replaced by name
    built = 0.5 * sp.Max(u, v) + sp.Abs(u) ** 3 + sp.atan2(v, u) + sp.sec(u) + a
    twin = parse("0.5*max(u, v) + abs(u)**3 + atan2(v, u) + sec(u) + 0.1")
    places = np.array([[0.3, 0.8], [-0.7, 0.2]])
    assert _values(parse(built, parameters={"a": 0.1}), places) == pytest.approx(
        _values(twin, places), rel=1e-15
    )
    for refused in (
        sp.gamma(u),
        sp.I * u,
        sp.Symbol("w"),
        u > 0,
        sp.Piecewise((u, u > 0)),  # and elsewhere?
    ):
        with pytest.raises(FormulaError):
            parse(refused)


def test_sympy_names_and_objects_mean_the_same():
    u, v = sp.symbols("u v")
    places = np.array([[0.3, 0.8], [-0.7, 0.2]])
    for built, text in (
        (sp.Max(u, v, 0), "Max(u, v, 0)"),
        (sp.Min(sp.Abs(u), v), "Min(Abs(u), v)"),
        (sp.sech(u) + sp.coth(u), "sech(u) + coth(u)"),
        (sp.Heaviside(u) * sp.sign(v), "Heaviside(u) * sign(v)"),
        (sp.floor(3 * u) + sp.ceiling(3 * v) + sp.frac(u), "floor(3*u) + ceil(3*v) + u - floor(u)"),
        (sp.sinc(u) + sp.erfc(v), "sinc(u) + erfc(v)"),
        (sp.Piecewise((u**2, u > 0), (0, True)), "Heaviside(u)*u**2"),
        (sp.Piecewise((u, (u > 0) & (v < 0.5)), (1, u <= 0), (2, True)), "(3 + sign(u)) / 2"),
    ):
        assert _values(parse(built), places) == pytest.approx(_values(parse(text), places))


def test_an_unknown_function_is_refused_with_those_that_are_known():
    for wrong, meant in (("sinn(u)", "sin or sinh"), ("Maxx(u, v)", "max"), ("arccoss(u)", "")):
        with pytest.raises(FormulaError) as refusal:
            parse(wrong)
        assert f"did you mean {meant}" in str(refusal.value) or not meant
        assert "sech" in refusal.value.reason and "\n" not in refusal.value.reason


def test_numbers_for_bounds():
    assert parse_number("2*pi") == math.tau
    assert parse_number("-sqrt(2)/2") == -math.sqrt(2) / 2
    assert parse_number(3) == 3.0
    assert parse_number(2 * sp.pi) == math.tau
    for refused in ("u", "inf", "nan", math.inf, math.nan, "1/0", "", None, True, [1]):
        with pytest.raises(FormulaError):
            parse_number(refused)


def test_parameters_must_be_finite():
    with pytest.raises(SurfaceError):
        parse("a*u", parameters={"a": math.nan})


def _values(expression, places):
    """Values of one expression at places (n, 2)."""
    return compiled([expression] * 3, (U, V)).evaluate(places)[0][:, 0]


_tokens = st.sampled_from(
    "u v 0 1 2 60 0.5 1e-9 pi e + - * / ** ( ) , sin( log( sqrt( min( atan2( cbrt( ) )".split()
)


@given(st.one_of(st.text(max_size=40), st.lists(_tokens, max_size=14).map(" ".join)))
@settings(max_examples=400, deadline=2000, derandomize=True)
def test_any_text_is_a_formula_or_refused(text):
    """Nothing else is ever raised, and what is accepted can be compiled."""
    try:
        expression = parse(text)
    except FormulaError as refused:
        assert 1 <= refused.column <= len(text) + 1
    else:
        assert surface_tape([expression] * 3, (U, V), 2).broken_invariant() == ""
