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


def up_to(limit: float, truth):
    """The same beyond |x| = limit as there, where doubles have long reached 0, 1 or infinity."""
    return lambda x: truth(min(max(x, mpmath.mpf(-limit)), mpmath.mpf(limit)))


BELOW_1 = 1.0 - 2.0**-53
FUNCTIONS = [
    Case("sin", mpmath.sin, 0.85),
    Case("cos", mpmath.cos, 0.85),
    Case("tan", mpmath.tan, 1.0),
    Case("exp", up_to(800, mpmath.exp), 0.7),
    Case("log", mpmath.log, 0.6, 5e-324),
    Case("asin", mpmath.asin, 0.65, -1.0, 1.0),
    Case("acos", mpmath.acos, 0.65, -1.0, 1.0),
    Case("atan", mpmath.atan, 0.7),
    Case("sinh", up_to(800, mpmath.sinh), 1.0),
    Case("cosh", up_to(800, mpmath.cosh), 1.0),
    Case("tanh", up_to(800, mpmath.tanh), 1.0),
    Case("asinh", mpmath.asinh, 0.6),
    Case("acosh", mpmath.acosh, 0.6, 1.0),
    Case("atanh", mpmath.atanh, 0.6, -BELOW_1, BELOW_1),
    Case("cbrt", lambda x: mpmath.sign(x) * mpmath.cbrt(abs(x)), 0.51),
    Case("erf", up_to(40, mpmath.erf), 1.0),
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


NAN, INF = float("nan"), float("inf")
EVERYWHERE = [case.name for case in FUNCTIONS] + ["bessel_0", "bessel_1", "bessel_2"]
ODD = ("sin", "tan", "asin", "atan", "sinh", "tanh", "asinh", "atanh", "cbrt", "erf", "bessel_1")
SPECIAL = [
    *[(name, NAN, NAN) for name in EVERYWHERE],
    *[(name, x, x) for name in ODD for x in (0.0, -0.0)],
    *[(name, x, 1.0) for name in ("cos", "exp", "cosh", "bessel_0") for x in (0.0, -0.0)],
    *[
        (name, x, NAN)
        for name in ("sin", "cos", "tan", "asin", "acos", "atanh")
        for x in (INF, -INF)
    ],
    *[(name, x, x) for name in ("sinh", "asinh", "cbrt") for x in (INF, -INF)],
    *[(name, sign * INF, sign) for name in ("tanh", "erf") for sign in (1.0, -1.0)],
    *[(f"bessel_{n}", x, 0.0) for n in range(3) for x in (INF, -INF)],
    *[("exp", INF, INF), ("exp", -INF, 0.0), ("exp", 1e4, INF), ("exp", -1e4, 0.0)],
    *[("log", 0.0, -INF), ("log", -0.0, -INF), ("log", 1.0, 0.0), ("log", -1.0, NAN)],
    *[("log", INF, INF), ("log", -INF, NAN), ("log", -5e-324, NAN)],
    *[("acos", 1.0, 0.0), ("acos", -1.0, np.pi), ("acos", 0.0, np.pi / 2), ("acos", 1.5, NAN)],
    *[("asin", 1.0, np.pi / 2), ("asin", -1.0, -np.pi / 2), ("asin", -1.5, NAN)],
    *[("atan", INF, np.pi / 2), ("atan", -INF, -np.pi / 2), ("atan", 1.0, np.pi / 4)],
    *[("cosh", INF, INF), ("cosh", -INF, INF), ("sinh", 800.0, INF), ("sinh", -800.0, -INF)],
    *[("acosh", 1.0, 0.0), ("acosh", 0.5, NAN), ("acosh", INF, INF), ("acosh", -INF, NAN)],
    *[("atanh", 1.0, INF), ("atanh", -1.0, -INF), ("atanh", 1.5, NAN), ("atanh", INF, NAN)],
    *[("cbrt", n**3.0, n) for n in (-7.0, 2.0, 3.0, 10.0)],
    *[("bessel_2", 0.0, 0.0), ("bessel_2", -0.0, 0.0)],
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


ANGLES = [
    *[(y, x, np.copysign(0.0, y)) for y in (0.0, -0.0) for x in (0.0, 1.0, INF)],
    *[(y, x, np.copysign(np.pi, y)) for y in (0.0, -0.0) for x in (-0.0, -1.0, -INF)],
    *[(y, x, np.copysign(np.pi / 2, y)) for y in (1.0, -1.0) for x in (0.0, -0.0)],
    *[(y, x, np.copysign(np.pi / 2, y)) for y in (INF, -INF) for x in (3.0, -3.0)],
    *[(y, x, np.copysign(np.pi, y)) for y in (2.0, -2.0) for x in (-INF, -1e300)],
    *[(2.0, INF, 0.0), (-2.0, INF, -0.0), (INF, INF, np.pi / 4), (-INF, INF, -np.pi / 4)],
    *[(INF, -INF, 3 * np.pi / 4), (-INF, -INF, -3 * np.pi / 4), (5e-324, 5e-324, np.pi / 4)],
    *[(NAN, 1.0, NAN), (1.0, NAN, NAN), (1e-320, 1e300, 0.0), (1e300, 1e-320, np.pi / 2)],
]
LENGTHS = [
    *[(INF, NAN, INF), (NAN, -INF, INF), (NAN, 1.0, NAN), (0.0, -0.0, 0.0), (-3.0, 4.0, 5.0)],
    *[(3e300, -4e300, 5e300), (3e-310, 4e-310, 5e-310), (1.7e308, 1.7e308, INF)],
]
POWERS = [
    *[(x, y, 1.0) for x in (0.0, -2.0, INF, NAN) for y in (0.0, -0.0)],
    *[(1.0, y, 1.0) for y in (-3.0, INF, -INF, NAN)],
    *[(-1.0, INF, 1.0), (-1.0, -INF, 1.0), (NAN, 2.0, NAN), (2.0, NAN, NAN), (-2.0, 0.5, NAN)],
    *[(0.0, -3.0, INF), (-0.0, -3.0, -INF), (-0.0, -2.0, INF), (-0.0, -INF, INF)],
    *[(0.0, 3.0, 0.0), (-0.0, 3.0, -0.0), (-0.0, 2.0, 0.0), (-0.0, 0.5, 0.0), (0.0, INF, 0.0)],
    *[(0.5, INF, 0.0), (2.0, INF, INF), (0.5, -INF, INF), (-2.0, -INF, 0.0)],
    *[(INF, 0.3, INF), (INF, -0.3, 0.0), (-INF, 3.0, -INF), (-INF, 2.0, INF), (-INF, -3.0, -0.0)],
    *[(-2.0, 3.0, -8.0), (-2.0, 2.0, 4.0), (10.0, 2.0, 100.0), (2.0, -1074.0, 5e-324)],
    *[(2.0, 1e300, INF), (2.0, -1e300, 0.0), (0.5, 1e300, 0.0), (7.0, 1e-300, 1.0)],
    *[(2.0, 1023.0, 2.0**1023), (4.0, 512.0, INF), (9.0, 0.5, 3.0), (-2.0, 1e300, INF)],
]


@pytest.mark.parametrize(
    ("name", "a", "b", "expected"),
    [("atan2", *case) for case in ANGLES]
    + [("pow", *case) for case in POWERS]
    + [("hypot", *case) for case in LENGTHS],
)
def test_special_values_of_two_numbers(name, a, b, expected):
    """Those of C99, annex F.10."""
    function = getattr(own, name)
    for found in (function(a, b), function(np.full(3, a), np.full(3, b))[1]):
        if np.isnan(expected):
            assert np.isnan(found)
        else:
            assert (found, np.signbit(found)) == (expected, np.signbit(expected))


def pairs_of_numbers(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    a, b = np.ldexp(rng.uniform(-1.0, 1.0, (2, 3000)), rng.integers(-20, 20, (2, 3000)))
    c, d = rng.uniform(-2.0, 2.0, (2, 3000))
    near = c * (1.0 + np.ldexp(rng.uniform(-1.0, 1.0, 3000), -rng.integers(1, 60, 3000)))
    wide = np.ldexp(rng.uniform(-1.0, 1.0, (2, 2000)), rng.integers(-1073, 1024, (2, 2000)))
    return np.concatenate([a, c, c, wide[0]]), np.concatenate([b, d, near, wide[1]])


def test_errors_of_the_angle():
    y, x = pairs_of_numbers(np.random.default_rng(4))
    with mpmath.workprec(180):
        for a, b, found in zip(y.tolist(), x.tolist(), own.atan2(y, x).tolist()):
            truth = mpmath.atan2(mpmath.mpf(a), mpmath.mpf(b))
            assert error_in_ulps(found, truth) <= 0.7, f"at {a.hex()}, {b.hex()}"
            assert own.atan2(a, b) == found


def test_errors_of_lengths():
    x, y = pairs_of_numbers(np.random.default_rng(8))
    with mpmath.workprec(180):
        for a, b, found in zip(x.tolist(), y.tolist(), own.hypot(x, y).tolist()):
            truth = mpmath.sqrt(mpmath.mpf(a) ** 2 + mpmath.mpf(b) ** 2)
            assert error_in_ulps(found, truth) <= 0.51, f"at {a.hex()}, {b.hex()}"
            assert own.hypot(a, b) == found


def test_errors_of_powers():
    x, y = pairs_of_numbers(np.random.default_rng(5))
    x = np.abs(np.concatenate([x, np.ldexp(x[:2000], -1000), 1.0 + 1e-5 * x[:2000]]))
    y = np.concatenate([y, y[:2000] / 50.0, 1e6 * y[:2000]])
    with mpmath.workprec(180):
        for a, b, found in zip(x.tolist(), y.tolist(), own.pow(x, y).tolist()):
            exponent = mpmath.mpf(b) * mpmath.log(mpmath.mpf(a))
            truth = mpmath.exp(max(min(exponent, mpmath.mpf(800)), mpmath.mpf(-800)))
            assert error_in_ulps(found, truth) <= 1.0, f"at {a.hex()}, {b.hex()}"
            assert own.pow(a, b) == found


@pytest.mark.parametrize("order", [0, 1, 2])
def test_errors_of_bessel_functions(order):
    rng = np.random.default_rng(6)
    x = np.concatenate([rng.uniform(-30, 30, 3000), rng.uniform(-4, 4, 3000), np.arange(-9.0, 9.0)])
    x = np.concatenate([x, np.ldexp(rng.uniform(-1.0, 1.0, 1000), rng.integers(-300, 0, 1000))])
    with mpmath.workprec(300):
        for a, found in zip(x.tolist(), getattr(own, f"bessel_{order}")(x).tolist()):
            z, scale = mpmath.mpf(a), mpmath.mpf(max(abs(a), 5e-324))
            if a == 0.0:
                continue
            truth = mpmath.sqrt(mpmath.pi / (2 * abs(z))) * mpmath.besselj(order + 0.5, abs(z))
            truth *= mpmath.sign(z) ** order
            if abs(a) <= 2.0:
                assert error_in_ulps(found, truth) <= 2.0, a
            else:
                assert abs(mpmath.mpf(found) - truth) <= 4 * 2.0**-53 / scale, a


INCREASING = {
    **{"exp": (-700, 700), "log": (1e-3, 1e3), "asin": (-1, 1), "atan": (-9, 9), "cbrt": (-9, 9)},
    **{"sinh": (-9, 9), "tanh": (-3, 3), "asinh": (-9, 9), "acosh": (1, 9), "atanh": (-1, 1)},
    **{"erf": (-5, 5), "tan": (-1.5, 1.5), "sin": (-1.5, 1.5)},
}


@pytest.mark.parametrize("name", INCREASING)
def test_functions_increase_but_for_their_last_bits(name):
    """By two ulps at most between neighbours: the bounds of a tape leave room for that."""
    first, last = INCREASING[name]
    rng = np.random.default_rng(7)
    x = rng.uniform(first, last, 20000)
    x = np.concatenate([x, np.arange(-32, 33) / 16.0, np.arange(-16, 17) * np.log(2.0) / 2.0])
    x = x[(x > first) & (x < last)]
    function = getattr(own, name)
    here, there = function(x), function(np.nextafter(x, np.inf))
    assert (here - there <= 2.0 * np.spacing(np.abs(here))).all()


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
