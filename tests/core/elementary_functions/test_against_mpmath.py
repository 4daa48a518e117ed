"""The elementary functions against mpmath: errors in ulps, special values, blocks."""

from typing import NamedTuple

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core import elementary_functions as own

PRECISION = 1250  # bits: so many that the argument 2^1023 loses nothing
LOWEST = -1074  # exponent of the smallest double


class Case(NamedTuple):
    """A function, its true value, the largest error in ulps, and where it is defined."""

    name: str
    truth: object
    error: float
    first: float = -np.inf
    last: float = np.inf

    @property
    def own(self):
        return getattr(own, self.name)


FUNCTIONS = [
    Case("sin", mpmath.sin, 0.85),
    Case("cos", mpmath.cos, 0.85),
    Case("tan", mpmath.tan, 1.0),
]
by_name = pytest.mark.parametrize("tested", FUNCTIONS, ids=lambda tested: tested.name)
FINITE = st.floats(allow_nan=False, allow_infinity=False)


def error_in_ulps(found: float, truth: mpmath.mpf) -> float:
    if truth == 0:
        return 0.0 if found == 0 else np.inf
    exponent = max(int(mpmath.frexp(truth)[1]) - 53, LOWEST)
    if abs(truth) >= mpmath.mpf(2) ** 1024:
        return 0.0 if np.isinf(found) else np.inf
    return float(abs(mpmath.mpf(found) - truth) / mpmath.mpf(2) ** exponent)


def arguments(tested: Case, rng: np.random.Generator) -> np.ndarray:
    """Random, near steps of every binary exponent, tiny, huge, near multiples of pi/2."""
    spread = np.ldexp(rng.uniform(-1.0, 1.0, 2000), rng.integers(-1073, 1024, 2000))
    nice = np.ldexp(rng.uniform(-1.0, 1.0, 2000), rng.integers(-30, 11, 2000))
    quarters = np.arange(-300, 300) * (0.5 * np.pi)
    whole = np.concatenate([np.arange(-40.0, 41.0), np.arange(-40.0, 41.0) / 16.0])
    edges = np.ldexp(1.0, np.arange(-40, 40))
    near = np.concatenate([quarters, whole, edges, -edges])
    near = np.concatenate([near, np.nextafter(near, np.inf), np.nextafter(near, -np.inf)])
    # worst cases of reduction: J.-M. Muller, Elementary Functions, 3rd edition, chapter 11
    hard = [6381956970095103.0 * 2.0**797, 1e22, 1e300, np.finfo(float).max, 5e-324]
    x = np.concatenate([spread, nice, near, hard])
    return x[(x >= tested.first) & (x <= tested.last)]


@by_name
def test_errors(tested):
    x = arguments(tested, np.random.default_rng(1))
    with mpmath.workprec(PRECISION if tested.name in ("sin", "cos", "tan") else 180):
        errors = [
            error_in_ulps(found, tested.truth(mpmath.mpf(number)))
            for number, found in zip(x.tolist(), tested.own(x).tolist())
        ]
    worst = int(np.argmax(errors))
    assert errors[worst] <= tested.error, f"at {x[worst].hex()}"


@by_name
@settings(max_examples=300, deadline=None)
@given(x=FINITE)
def test_errors_anywhere(tested, x):
    if tested.first <= x <= tested.last:
        with mpmath.workprec(PRECISION if tested.name in ("sin", "cos", "tan") else 180):
            assert error_in_ulps(tested.own(x), tested.truth(mpmath.mpf(x))) <= tested.error


@by_name
def test_blocks_have_the_same_bits_as_single_numbers(tested):
    x = arguments(tested, np.random.default_rng(2))
    x = np.concatenate([x, [np.inf, -np.inf, np.nan, 0.0, -0.0], np.linspace(0.1, 0.9, 700)])
    single = np.array([tested.own(number) for number in x.tolist()])
    for count in (0, 1, 255, 256, 257, len(x)):
        assert (
            tested.own(x[-count:] if count else x[:0]).tobytes()
            == (single[-count:] if count else single[:0]).tobytes()
        )
    table = x[: len(x) // 6 * 6].reshape(-1, 2, 3)
    assert tested.own(table).shape == table.shape
    assert tested.own(x[::2]).tobytes() == single[::2].tobytes()  # not contiguous
    assert tested.own(np.array(0.5)).shape == ()


NAN = float("nan")
SPECIAL = [
    *[(name, x, NAN) for name in ("sin", "cos", "tan") for x in (np.inf, -np.inf, NAN)],
    *[(name, x, x) for name in ("sin", "tan") for x in (0.0, -0.0)],
    ("cos", 0.0, 1.0),
    ("cos", -0.0, 1.0),
]


@pytest.mark.parametrize(("name", "x", "expected"), SPECIAL)
def test_special_values(name, x, expected):
    """Those of C99, annex F.10."""
    function = getattr(own, name)
    for found in (function(x), function(np.full(3, x))[1]):
        if np.isnan(expected):
            assert np.isnan(found)
        else:
            assert (found, np.signbit(found)) == (expected, np.signbit(expected))


def test_sine_and_cosine_together():
    x = arguments(FUNCTIONS[0], np.random.default_rng(3))
    sine, cosine = own.sincos(x)
    assert sine.tobytes() == own.sin(x).tobytes()
    assert cosine.tobytes() == own.cos(x).tobytes()
    assert own.sincos(1.0) == (own.sin(1.0), own.cos(1.0))


def test_what_is_no_array_of_numbers_is_refused():
    for wrong in ("text", None, [[1.0], [2.0, 3.0]], np.array(["a"]), 1j):
        with pytest.raises((TypeError, ValueError)):
            own.sin(wrong)
