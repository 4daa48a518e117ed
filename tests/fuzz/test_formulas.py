"""Any formula gives a surface or is refused in one line: no other exception, no warning.

``SURFMESH_FUZZ=2000 pytest tests/fuzz/test_formulas.py`` tries that many.
"""

import math
import os
import warnings

import numpy as np
import pytest
import sympy as sp
from fuzz.formula_grammar import Grammar

import surfmesh as sm
from surfmesh.errors import FormulaError, SizingError, SurfaceError, SurfmeshError

SEEDS = int(os.environ.get("SURFMESH_FUZZ", "200"))
MESHED = 25  # every so manieth surface is meshed, coarsely


def is_one_line(error: SurfmeshError) -> bool:
    text = error.reason if isinstance(error, FormulaError) else str(error)
    return bool(text) and all(character.isprintable() for character in text)


@pytest.mark.parametrize("first", range(0, SEEDS, 20))
def test_a_formula_is_a_surface_or_refused_in_one_line(first):
    for seed in range(first, min(first + 20, SEEDS)):
        arguments = Grammar(seed).surface()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                surface = sm.ParametricSurface(**arguments)
            except SurfmeshError as error:
                assert is_one_line(error), (seed, arguments)
                continue
            except Exception as error:
                raise AssertionError(f"seed {seed}: {arguments}") from error
            places = 0.5 * np.array(surface.domain).sum(axis=1) * np.ones((3, 1))
            assert len(surface.evaluate(places, 2)) == 6
            assert surface.tape(2).broken_invariant() == ""
            surface.guides()
            if seed % MESHED == 0:
                try:
                    sm.mesh(surface, sm.Sizing(chord=0.1, min_size=0.2, limit=20_000))
                except SurfmeshError as error:
                    assert is_one_line(error), (seed, arguments)


LONG = {
    "sines": "+".join(f"sin({k}*u+{k % 7}*v)*cos({k % 5}*v)" for k in range(1, 301)),
    "tower": "(1+u*v)" + "**(1+u/9" * 20 + ")" * 20,
    "nest": "sin(u*" * 60 + "v" + ")" * 60,
    "choices": "+".join(f"max(u-{k}/300,v,0)" for k in range(1, 300)),
    "roots": "+".join(f"u**0.{k}" for k in range(1, 600)),
    "fraction": "1/(1+u*" * 60 + "v" + ")" * 60,
}


@pytest.mark.parametrize("name", LONG)
def test_long_formulas_are_differentiated_at_once(name):
    """As expressions they took up to a minute."""
    surface = sm.ParametricSurface("u", "v", LONG[name], u=(0.1, 1), v=(0.2, 1))
    assert len(surface.tape(2).instructions) < 15_000


def deep_expression():
    deep = sp.Symbol("u")
    for _ in range(400):
        deep = sp.sin(deep, evaluate=False)
    return deep


def endless_expression():
    shared = sp.Symbol("u")
    for _ in range(60):
        shared = sp.Add(shared, shared, evaluate=False)
    return shared


@pytest.mark.parametrize(
    "z, reason",
    [
        (deep_expression(), "levels"),
        (endless_expression(), "operations"),
        (sp.Integer(10) ** 5000 * sp.Symbol("u"), "too large"),
        (sp.nan, "not part of a formula"),
        (10**400, "finite number"),
        (10**5000, "finite number"),
        ([10**5000], "a formula is text"),
        (1j, "a formula is text"),
        ("*".join(f"(u*1.{10**27 + k})**60" for k in range(100)), "too many digits"),
        ("\u202eu", r"U\+202E"),
        ("u\x1b[31m", "not part of a formula"),
        ("(" * 5000, "nested deeper"),
        ("u" * 1_000_000, "longer than"),
    ],
    ids=range(13),
)
def test_what_could_not_be_worked_with_is_refused_before_it_is(z, reason):
    with pytest.raises(FormulaError, match=reason) as refusal:
        sm.ParametricSurface("u", "v", z, u=(0, 1), v=(0, 1))
    assert is_one_line(refusal.value)


def test_numbers_of_every_kind_are_formulas_and_bounds():
    for number in (np.float64(0.5), np.float32(0.5), np.int64(3), sp.Rational(1, 3), 7):
        surface = sm.ParametricSurface("u", "v", number, u=(0, number), v=(0, 1))
        assert surface.evaluate(np.zeros((1, 2)))[0][0, 2] == float(number)


@pytest.mark.parametrize(
    "changes, reason",
    [
        ({"u": (0, 10**400)}, "finite"),
        ({"u": (0, 1j)}, "domain of u"),
        ({"u": (-1e300, 1e300)}, "change its unit"),
        ({"u": (0, 1e-300)}, "change its unit"),
        ({"u": (1, 1 + 1e-15)}, "too narrow"),
        ({"u": None}, "pair"),
        ({"loops": 5}, "loops are lists"),
        ({"loops": [[(0, 0), (1,)]]}, "loop 0"),
        ({"loops": [[(0, 0), (10**400, 1), (1, 1)]]}, "loop 0"),
        ({"loops": [np.array([[0, 0], [1j, 1], [1, 1]])]}, "loop 0"),
        ({"parameters": {"a": 10**400}}, "not finite"),
        ({"parameters": {1: 2.0}}, "cannot name"),
        ({"parameters": [1]}, "parameters is a mapping"),
        ({"z": "1e200*u"}, "too far away to compute with"),
    ],
)
def test_surfaces_with_odd_values_are_refused_in_one_line(changes, reason):
    given = {"x": "u", "y": "v", "z": "u*v", "u": (0, 1), "v": (0, 1)} | changes
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(SurfaceError, match=reason) as refusal:
            sm.ParametricSurface(**given)
    assert is_one_line(refusal.value)


ODD_FUNCTIONS = {
    "complex": lambda u, v: (u, v, u * 1j),
    "huge": lambda u, v: (u, v, u * 1e200),
    "masked": lambda u, v: (u, v, np.ma.masked_array(u * v, mask=u > 0.5)),
    "nothing": lambda u, v: None,
    "an integer beyond floats": lambda u, v: (u, v, [10**400] * len(u)),
    "ragged": lambda u, v: [[1], [2, 3], [4]],
    "text": lambda u, v: (u, v, "abc"),
    "one short": lambda u, v: (u, v, u[:-1]),
    "a root of negative numbers": lambda u, v: (u, v, np.sqrt(u - 2)),
}


@pytest.mark.parametrize("what", ODD_FUNCTIONS)
def test_functions_with_odd_values_are_refused_in_one_line(what):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(SurfaceError) as refusal:
            sm.NumericSurface(ODD_FUNCTIONS[what], u=(0, 1), v=(0, 2))
    assert is_one_line(refusal.value)


def test_derivatives_of_another_function_are_refused():
    """Meshing with them had no end."""

    def wrong(u, v):
        return (1, 0, -5 * v), (0, 1, 7 * u)

    with pytest.raises(SurfaceError, match="where f changes by"):
        sm.NumericSurface(lambda u, v: (u, v, u * v), (0, 1), (0, 2), derivatives=wrong)


def test_what_a_function_raises_says_which_places_were_asked_for():
    def broken(u, v):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine") as caught:
        sm.NumericSurface(broken, (0, 1), (0, 2))
    assert "u from 0 to 1 and v from 0 to 2" in caught.value.__notes__[0]


@pytest.mark.parametrize(
    "asked",
    [
        {"chord": value}
        for value in (-1, 0, math.nan, math.inf, True, "x", [1], 1j, 10**400, 10**5000, 1e-300)
    ]
    + [{"size": 1e-300}, {"size": np.array([0.1])}, {"anisotropy": 1e300}, {"limit": 10**400}],
    ids=range(15),
)
def test_odd_requests_are_refused_in_one_line(asked):
    with pytest.raises(SizingError) as refusal:
        sm.Sizing(**asked)
    assert is_one_line(refusal.value)


@pytest.mark.parametrize(
    "law",
    [
        lambda p: p[:, 0] + 1j,
        lambda p: p,
        lambda p: None,
        lambda p: "x",
        lambda p: -p[:, 0],
        lambda p: [10**400] * len(p),
        lambda p: [[1], [1, 2]],
        lambda p: np.sqrt(p[:, 0] - 2),
    ],
)
def test_size_laws_with_odd_values_are_refused_in_one_line(law):
    plane = sm.ParametricSurface("u", "v", "u*v", u=(0, 1), v=(0, 1))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(SizingError) as refusal:
            sm.mesh(plane, sm.Sizing(size=law))
        assert is_one_line(refusal.value)
        with pytest.raises(SizingError) as refusal:
            sm.pack(law, count=50)
    assert is_one_line(refusal.value)


def test_a_surface_that_asks_for_too_much_is_refused_before_its_field_is_made():
    """The field of sin(1000 u) sin(1000 v) was first filled with millions of cells."""
    waves = sm.ParametricSurface("u", "v", "sin(1000*u)*sin(1000*v)", u=(-1, 1), v=(-1, 1))
    with pytest.raises(SizingError, match="far more than the limit"):
        sm.mesh(waves)
