"""Tapes of the core against their slow twin, values inside bounds, broken programs refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import tape as naive

from surfmesh._core import surfaces
from surfmesh.geometry.formulas.tape import Instruction, Tape

ARITHMETIC = (
    *("add", "subtract", "multiply", "divide", "negative", "reciprocal", "sqrt", "absolute"),
    *("signum", "unit_step", "floor", "chosen", "step", "side", "kink", "jump", "tread", "cut"),
    *("minimum", "maximum"),
)
OPERANDS = {
    **dict.fromkeys(surfaces.OPERATIONS, 1),
    **dict.fromkeys(["add", "subtract", "multiply", "divide", "power", "angle", "turn", "cut"], 2),
    **{"minimum": 2, "maximum": 2, "chosen": 3},
}
by_operation = pytest.mark.parametrize("operation", surfaces.OPERATIONS)
SPECIAL = [0.0, -0.0, 1.0, -1.0, 0.5, 2.0, np.pi, -np.pi / 2, 7.5, 1e-300, 1e5, -1e5]


def tape_of(operation: str, exponent: int = 0) -> Tape:
    count = OPERANDS[operation]
    step = Instruction(operation, count, tuple(range(count)), exponent)
    return Tape(count, (), (step,), 1, (count,) * 3)


def tapes_of(operation: str) -> list[Tape]:
    exponents = (2, 3, 4, 5, 7, 12, 64) if operation == "integer_power" else (0,)
    return [tape_of(operation, exponent) for exponent in exponents]


def numbers(rng: np.random.Generator, count: int) -> np.ndarray:
    x = rng.uniform(-4.0, 4.0, (1500, count))
    x[:500] *= np.ldexp(1.0, rng.integers(-60, 6, (500, count)))
    x[500:900] = rng.choice(SPECIAL, (400, count))
    return x


def cells(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    a, b = numbers(rng, count), numbers(rng, count)
    near = a + np.abs(a) * np.ldexp(rng.uniform(0.0, 1.0, a.shape), -rng.integers(0, 50, a.shape))
    b[::2] = near[::2]
    a[::7] = b[::7]
    lo, hi = np.minimum(a, b), np.maximum(a, b)
    lo[3::50, 0], hi[7::50, 0] = -np.inf, np.inf
    return lo, hi


def same(found: np.ndarray, expected: np.ndarray, tolerance: float) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        equal = (found == expected) | (np.isnan(found) & np.isnan(expected))
        return equal | (np.abs(found - expected) <= tolerance * np.abs(expected))


@by_operation
def test_values_are_those_of_the_slow_twin(operation):
    points = numbers(np.random.default_rng(1), OPERANDS[operation])
    for tape in tapes_of(operation):
        (found,), (expected,) = tape.evaluate(points), naive.evaluate(tape, points)
        tolerance = 0.0 if operation in (*ARITHMETIC, "integer_power") else 1e-15
        if operation.startswith("bessel"):  # relative to their envelope
            found, expected = found + 10.0, expected + 10.0
        bad = ~same(found, expected, tolerance)
        assert not bad.any(), (points[bad[:, 0]][0], found[bad][0], expected[bad][0])


@by_operation
def test_bounds_are_those_of_the_slow_twin(operation):
    lo, hi = cells(np.random.default_rng(2), OPERANDS[operation])
    for tape in tapes_of(operation):
        found, expected = tape.bounds(lo, hi), naive.bounds(tape, lo, hi)
        tolerance = 0.0 if operation in ARITHMETIC else 3e-14
        for one, other in zip(found, expected):
            if operation.startswith("bessel"):
                one, other = one + 10.0, other + 10.0
            bad = ~same(one, other, tolerance)
            if operation == "power":  # the twin takes no negative base
                bad &= lo[:, :1] >= 0.0
            assert not bad.any(), (lo[bad[:, 0]][0], hi[bad[:, 0]][0], one[bad][0], other[bad][0])


@by_operation
def test_values_lie_inside_bounds(operation):
    rng = np.random.default_rng(3)
    lo, hi = cells(rng, OPERANDS[operation])
    lo, hi = np.clip(lo, -1e5, 1e5), np.clip(hi, -1e5, 1e5)
    for tape in tapes_of(operation):
        lower, upper = tape.bounds(lo, hi)
        for t in (0.0, 1.0, *rng.uniform(0.0, 1.0, 8)):
            points = np.clip(lo + t * (hi - lo), lo, hi)
            (values,) = tape.evaluate(points)
            if operation in ("kink", "jump", "tread", "cut", "step", "side", "turn"):
                continue  # slopes of one side, angles up to whole turns: tested with surfaces
            values[~np.isfinite(values)] = np.nan  # undefined
            outside = (values < lower) | (values > upper)
            assert not outside.any(), (points[outside[:, 0]][0], lo[outside[:, 0]][0])


SMOOTH = [name for name in surfaces.OPERATIONS if name not in ("integer_power", "turn", "floor")]
SMOOTH = [name for name in SMOOTH if name not in ("kink", "jump", "tread", "cut", "step", "side")]


@st.composite
def programs(draw) -> Tape:
    """Random programs of two inputs and two constants that write each register once."""
    constants = draw(st.lists(st.floats(-3.0, 3.0), min_size=2, max_size=2))
    steps, fixed = [], 4
    for number in range(draw(st.integers(1, 12))):
        operation = draw(st.sampled_from([*SMOOTH, "integer_power"]))
        slots = st.integers(0, fixed + number - 1)
        operands = tuple(draw(slots) for _ in range(OPERANDS[operation]))
        exponent = draw(st.integers(2, 9)) if operation == "integer_power" else 0
        steps.append(Instruction(operation, fixed + number, operands, exponent))
    return Tape(2, tuple(constants), tuple(steps), len(steps), (fixed + len(steps) - 1,) * 3)


@settings(max_examples=400, deadline=None)
@given(
    programs(),
    st.tuples(*[st.floats(-3.0, 3.0)] * 2),
    st.tuples(*[st.floats(0.0, 2.0)] * 2),
    st.integers(0, 2**32),
)
def test_values_of_programs_lie_inside_bounds(tape, corner, size, seed):
    lo, hi = np.array([corner]), np.array([corner]) + np.array([size])
    lower, upper = tape.bounds(lo, hi)
    points = lo + np.random.default_rng(seed).uniform(0.0, 1.0, (50, 2)) * (hi - lo)
    values = tape.evaluate(np.clip(points, lo, hi))[0]
    values[~np.isfinite(values)] = np.nan  # undefined
    room = 1e-9 * (1.0 + np.abs(values))  # cancellation inside a program is no part of the margin
    assert not ((values < lower - room) | (values > upper + room)).any()


@settings(max_examples=200, deadline=None)
@given(programs(), st.integers(0, 2**32), st.sampled_from([1, 2, 255, 256, 257, 700]))
def test_blocks_do_not_show(tape, seed, count):
    points = np.random.default_rng(seed).uniform(-2.0, 2.0, (count, 2))
    (all_at_once,) = tape.evaluate(points)
    each = np.concatenate([tape.evaluate(point[None])[0] for point in points[:: count // 20 + 1]])
    assert all_at_once[:: count // 20 + 1].tobytes() == each.tobytes()
    lower, upper = tape.bounds(points, points + 0.1)
    last = tape.bounds(points[-1:], points[-1:] + 0.1)
    assert lower[-1:].tobytes() == last[0].tobytes()
    assert upper[-1:].tobytes() == last[1].tobytes()


GOOD = Tape(2, (1.0,), (Instruction("add", 3, (0, 2)), Instruction("sin", 4, (3,))), 2, (4, 4, 4))
BROKEN = {
    "before it is written": [("add", 3, (0, 3)), ("add", 3, (0, 9)), ("add", 3, (0, -1))],
    "outside the registers": [("add", 2, (0, 1)), ("add", 5, (0, 1)), ("add", -1, (0, 1))],
    "takes 2 operands": [("add", 3, (0,)), ("add", 3, (0, 1, 2))],
    "no operation": [("eval", 3, (0,)), ("", 3, (0,))],
    "below 2": [("integer_power", 3, (0,), 1), ("integer_power", 3, (0,), -7)],
}


@pytest.mark.parametrize(("words", "step"), [(w, s) for w, steps in BROKEN.items() for s in steps])
def test_broken_programs_are_refused(words, step):
    assert GOOD.broken_invariant() == ""
    broken = Tape(2, (1.0,), (Instruction(*step), *GOOD.instructions), 2, (4, 4, 4))
    assert words in broken.broken_invariant()
    with pytest.raises(ValueError, match=words):
        broken.evaluate(np.zeros((1, 2)))


def test_powers_that_overwrite_their_base_and_lost_outputs_are_refused():
    steps = (Instruction("sin", 2, (0,)), Instruction("integer_power", 2, (2,), 3))
    assert "overwrites the base" in Tape(2, (), steps, 1, (2, 2, 2)).broken_invariant()
    for outputs in ((3, 2, 2), (-1, 2, 2), (7, 2, 2)):
        assert "never written" in Tape(2, (), steps[:1], 2, outputs).broken_invariant()
    assert "too many slots" in Tape(-1, (), (), 0, ()).broken_invariant()
    assert "too many slots" in Tape(2, (), (), 2**31 - 1, ()).broken_invariant()


def test_wrong_arguments_are_refused():
    for wrong in (np.zeros((3, 1)), np.zeros((3, 3)), np.zeros(3)):
        with pytest.raises((TypeError, ValueError)):
            GOOD.evaluate(wrong)
        with pytest.raises((TypeError, ValueError)):
            GOOD.bounds(wrong, wrong)
    with pytest.raises(ValueError, match="rows"):
        GOOD.bounds(np.zeros((3, 2)), np.zeros((2, 2)))
    lower, upper = GOOD.bounds(np.zeros((0, 2)), np.zeros((0, 2)))
    assert lower.shape == upper.shape == (0, 3)


def angles_tape(second: str, overwritten: bool) -> Tape:
    """Sine of an angle, then sine or cosine once more, with what register is free in between."""
    steps = [
        Instruction("add", 3, (0, 1)),
        Instruction("sin", 4, (3,)),
        Instruction("multiply", 5, (4, 2)),
        *([Instruction("negative", 3, (5,))] if overwritten else []),
        Instruction(second, 5, (3,)),
        Instruction("cos", 6, (3,)),
        Instruction("sin", 3, (3,)),
    ]
    return Tape(2, (0.5,), tuple(steps), 4, (4, 5, 6, 3, 4, 5))


@pytest.mark.parametrize("overwritten", [False, True])
@pytest.mark.parametrize("second", ["sin", "cos"])
def test_sine_and_cosine_of_one_angle_are_those_of_each_alone(second, overwritten):
    x = numbers(np.random.default_rng(3), 2)
    found = np.concatenate(angles_tape(second, overwritten).evaluate(x), axis=1)
    angle = tape_of("add").evaluate(x)[0][:, :1]
    sine = tape_of("sin").evaluate(angle)[0][:, :1]
    again = -0.5 * sine if overwritten else angle
    of_again = {name: tape_of(name).evaluate(again)[0][:, 0] for name in ("sin", "cos")}
    expected = [sine[:, 0], of_again[second], of_again["cos"], of_again["sin"]]
    np.testing.assert_array_equal(found[:, :4].T, expected)
