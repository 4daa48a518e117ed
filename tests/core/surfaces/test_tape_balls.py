"""Middles and radii of tapes at points hold what is true: computed with 60 digits."""

import mpmath
import numpy as np
import pytest

from surfmesh.geometry.formulas.tape import Instruction, Tape

mpmath.mp.dps = 60
FACTOR = 0.3  # taken within four ulps

EXACT = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": lambda a, b: a / b,
    "negative": lambda a, b: -a,
    "reciprocal": lambda a, b: 1 / a,
    "sqrt": lambda a, b: mpmath.sqrt(a),
    "exp": lambda a, b: mpmath.exp(a),
    "log": lambda a, b: mpmath.log(a),
    "sin": lambda a, b: mpmath.sin(a),
    "cos": lambda a, b: mpmath.cos(a),
    "tan": lambda a, b: mpmath.tan(a),
    "atan": lambda a, b: mpmath.atan(a),
    "tanh": lambda a, b: mpmath.tanh(a),
    "power": lambda a, b: a**b,
    "absolute": lambda a, b: abs(a),
    "maximum": max,
}
OF_TWO = ("add", "subtract", "multiply", "divide", "power", "maximum")
POSITIVE = ("sqrt", "log", "power")


def points(operation: str) -> np.ndarray:
    rng = np.random.default_rng(3)
    x = rng.uniform(-4.0, 4.0, (400, 2)) * np.ldexp(1.0, rng.integers(-40, 5, (400, 2)))
    x[:9] = [(1, 1), (2, 0.5), (-3, 2), (0.5, -0.5), (1e-8, 1), (30, 3), (-30, 1), (7, 7), (1, 0.1)]
    return np.abs(x) if operation in POSITIVE else x


def is_held(exact: mpmath.mpf, mid: float, rad: float) -> bool:
    return abs(exact - mpmath.mpf(mid)) <= mpmath.mpf(rad)


@pytest.mark.parametrize("operation", EXACT)
def test_what_is_true_is_within_the_radius(operation):
    """f(0.3 a, b), and the same times itself."""
    u, v, factor, a, found, square = range(6)
    operands = (a, v) if operation in OF_TWO else (a,)
    steps = (
        Instruction("multiply", a, (u, factor)),
        Instruction(operation, found, operands),
        Instruction("multiply", square, (found, found)),
    )
    given = points(operation)
    mid, rad = Tape(2, (FACTOR,), steps, 3, (found, square, a)).program.enclose(given)
    for (x, y), mids, radii in zip(given.tolist(), mid.tolist(), rad.tolist()):
        b = mpmath.mpf(y)
        for constant in (mpmath.mpf(FACTOR), mpmath.mpf(3) / 10):  # as written
            exact = EXACT[operation](mpmath.mpf(x) * constant, b)
            assert is_held(exact, mids[0], radii[0])
            assert is_held(exact * exact, mids[1], radii[1])
    sure = np.isfinite(rad[:, 0]) & (np.abs(given) > 1e-3).all(axis=1) & (np.abs(mid[:, 0]) > 0.1)
    if operation not in ("add", "subtract", "divide", "reciprocal", "tan"):  # which may lose digits
        assert (rad[sure, 0] <= 1e-12 * np.abs(mid[sure, 0])).all()


@pytest.mark.parametrize("exponent", [2, 3, 7, 40])
def test_powers(exponent):
    u, v, factor, a, found = range(5)
    steps = (
        Instruction("multiply", a, (u, factor)),
        Instruction("integer_power", found, (a,), exponent),
    )
    given = points("multiply")
    mid, rad = Tape(2, (FACTOR,), steps, 2, (found, a, v)).program.enclose(given)
    for x, one, radius in zip(given[:, 0].tolist(), mid[:, 0].tolist(), rad[:, 0].tolist()):
        assert is_held((mpmath.mpf(x) * mpmath.mpf(FACTOR)) ** exponent, one, radius)


@pytest.mark.parametrize("operation", ["reciprocal", "log", "sqrt"])
def test_nothing_is_known_where_a_function_ends(operation):
    """At 0, which a difference of equal numbers is within its round-off."""
    u, v, factor, a, b, zero, found = range(7)
    steps = (
        Instruction("multiply", a, (u, factor)),
        Instruction("multiply", b, (v, factor)),
        Instruction("subtract", zero, (a, b)),
        Instruction(operation, found, (zero,)),
    )
    mid, rad = Tape(2, (FACTOR,), steps, 4, (found, zero, a)).program.enclose(np.ones((3, 2)))
    if operation == "sqrt":  # [0, x]: as intervals say
        assert (np.abs(mid[:, 0]) + rad[:, 0] < 1e-7).all()
    else:
        assert np.isinf(rad[:, 0]).all()
    assert (mid[:, 1] == 0.0).all()
    assert (rad[:, 1] > 0.0).all()
