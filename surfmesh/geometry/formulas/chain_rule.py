"""Derivatives of straight-line programs, step by step: forward differentiation.

        value    t = a * b          rate    t' = b a' + a b'

Time and length grow with the number of steps alone, whatever the formula looks like.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

from surfmesh.geometry.formulas.program import Program


def derivatives(program: Program, values: Sequence[int], variable: int) -> list[int]:
    """Numbers of the values that are d/d ``variable`` of values of a program, which it extends."""
    rates = _Rates(program, variable)
    for step in _steps_behind(program, values):
        rates.follow(step)
    return [rates.of(value) for value in values]


def _steps_behind(program: Program, values: Sequence[int]) -> Iterator[int]:
    """Values of steps that others need, each after those it reads."""
    needed = bytearray(max([program.inputs, *values]) + 1)
    for value in values:
        if value >= 0:
            needed[value] = 1
    for value in range(len(needed) - 1, program.inputs - 1, -1):
        if needed[value]:
            for operand in program.steps[value - program.inputs][1]:
                if operand >= 0:
                    needed[operand] = 1
    return (value for value in range(program.inputs, len(needed)) if needed[value])


class _Rates:
    """The derivatives of the values of a program by one of its inputs."""

    def __init__(self, program: Program, variable: int) -> None:
        self.program = program
        self.zero = program.constant(0.0)
        self._known = {number: self.zero for number in range(program.inputs)}
        self._known[variable] = program.one

    def of(self, value: int) -> int:
        return self.zero if value < 0 else self._known[value]

    def follow(self, value: int) -> None:
        """The rate of a step, from those of its operands."""
        operation, operands, exponent = self.program.steps[value - self.program.inputs]
        rates = [self.of(operand) for operand in operands]
        if all(rate == self.zero for rate in rates):
            self._known[value] = self.zero
        elif operation == "integer_power":
            self._known[value] = self.times(self.slope_of_power(operands[0], exponent), *rates)
        elif operation in _RULES:
            self._known[value] = _RULES[operation](self, value, *operands, *rates)
        else:
            slope = _SLOPES[operation](self, value, operands[0])
            self._known[value] = self.times(slope, *rates)

    def number(self, x: float) -> int:
        return self.program.constant(x)

    def step(self, operation: str, *operands: int) -> int:
        return self.program.step(operation, *operands)

    def power(self, x: int, n: int) -> int:
        return self.program.step("integer_power", x, exponent=n)

    def slope_of_power(self, x: int, n: int) -> int:
        return self.times(self.number(float(n)), self.power(x, n - 1))

    def plus(self, a: int, b: int) -> int:
        if a == self.zero or b == self.zero:
            return b if a == self.zero else a
        return self.step("add", *sorted((a, b)))

    def minus(self, a: int, b: int) -> int:
        if b == self.zero:
            return a
        return self.negative(b) if a == self.zero else self.step("subtract", a, b)

    def negative(self, a: int) -> int:
        return a if a == self.zero else self.step("negative", a)

    def times(self, a: int, b: int) -> int:
        if self.zero in (a, b):
            return self.zero
        a, b = sorted((a, b))
        if self.program.one in (a, b):
            return b if a == self.program.one else a
        return self.step("multiply", a, b)

    def over(self, a: int, b: int) -> int:
        return a if a == self.zero else self.step("divide", a, b)


def _product(r: _Rates, _: int, a: int, b: int, da: int, db: int) -> int:
    return r.plus(r.times(b, da), r.times(a, db))


def _quotient(r: _Rates, value: int, a: int, b: int, da: int, db: int) -> int:
    return r.minus(r.over(da, b), r.over(r.times(value, db), b))


def _power(r: _Rates, value: int, a: int, b: int, da: int, db: int) -> int:
    """b a^(b - 1) a' + a^b log(a) b', where the exponent does not change without a logarithm."""
    total = r.zero
    if da != r.zero and b < 0:
        exponent = r.program.constants[-1 - b] - 1.0
        if exponent < 0.0:
            slope = r.over(b, r.step("power", a, r.number(-exponent)))
        else:
            slope = r.times(b, r.step("power", a, r.number(exponent)))
        total = r.times(slope, da)
    elif da != r.zero:
        total = r.over(r.times(r.times(value, b), da), a)
    if db == r.zero:
        return total
    return r.plus(total, r.times(r.times(value, r.step("log", a)), db))


def _turn(r: _Rates, _: int, y: int, x: int, dy: int, dx: int) -> int:
    square = r.plus(r.power(x, 2), r.power(y, 2))
    return r.over(r.minus(r.times(x, dy), r.times(y, dx)), square)


def _angle(r: _Rates, value: int, y: int, x: int, dy: int, dx: int) -> int:
    torn = r.times(r.step("cut", y, x), r.plus(dy, dx))
    return r.plus(_turn(r, value, y, x, dy, dx), torn)


def _cut(r: _Rates, value: int, y: int, x: int, dy: int, dx: int) -> int:
    return r.times(value, r.plus(dy, dx))


def _larger(r: _Rates, _: int, a: int, b: int, da: int, db: int) -> int:
    first, second = r.step("subtract", a, b), r.step("subtract", b, a)
    return r.plus(r.times(r.step("step", first), da), r.times(r.step("step", second), db))


def _smaller(r: _Rates, value: int, a: int, b: int, da: int, db: int) -> int:
    return _larger(r, value, b, a, da, db)


def _chosen(r: _Rates, _: int, d: int, a: int, b: int, dd: int, da: int, db: int) -> int:
    # the side that is not chosen may be undefined: its derivative stays behind the choice
    inner = r.zero if da == db == r.zero else r.step("chosen", d, da, db)
    return r.plus(r.times(r.step("jump", d), dd), inner)


_RULES: dict[str, Callable[..., int]] = {
    "add": lambda r, _, a, b, da, db: r.plus(da, db),
    "subtract": lambda r, _, a, b, da, db: r.minus(da, db),
    "multiply": _product,
    "divide": _quotient,
    "negative": lambda r, _, a, da: r.negative(da),
    "power": _power,
    "turn": _turn,
    "angle": _angle,
    "cut": _cut,
    "maximum": _larger,
    "minimum": _smaller,
    "chosen": _chosen,
}
"""Rates from the step's value, its operands and their rates."""


def _one_and(r: _Rates, sign: str, x: int) -> int:
    """1 + x^2 or 1 - x^2."""
    return r.step(sign, r.program.one, r.power(x, 2))


_SLOPES: dict[str, Callable[[_Rates, int, int], int]] = {
    "reciprocal": lambda r, y, x: r.negative(r.power(y, 2)),
    "sqrt": lambda r, y, x: r.over(r.number(0.5), y),
    "cube_root": lambda r, y, x: r.over(r.number(1.0 / 3.0), r.power(y, 2)),
    "exp": lambda r, y, x: y,
    "log": lambda r, y, x: r.over(r.program.one, x),
    "sin": lambda r, y, x: r.step("cos", x),
    "cos": lambda r, y, x: r.negative(r.step("sin", x)),
    "tan": lambda r, y, x: _one_and(r, "add", y),
    "asin": lambda r, y, x: r.over(r.program.one, r.step("sqrt", _one_and(r, "subtract", x))),
    "acos": lambda r, y, x: r.over(r.program.minus_one, r.step("sqrt", _one_and(r, "subtract", x))),
    "atan": lambda r, y, x: r.over(r.program.one, _one_and(r, "add", x)),
    "sinh": lambda r, y, x: r.step("cosh", x),
    "cosh": lambda r, y, x: r.step("sinh", x),
    "tanh": lambda r, y, x: _one_and(r, "subtract", y),
    "asinh": lambda r, y, x: r.over(r.program.one, r.step("sqrt", _one_and(r, "add", x))),
    "acosh": lambda r, y, x: r.over(
        r.over(r.program.one, r.step("sqrt", r.step("subtract", x, r.program.one))),
        r.step("sqrt", r.step("add", x, r.program.one)),
    ),
    "atanh": lambda r, y, x: r.over(r.program.one, _one_and(r, "subtract", x)),
    "erf": lambda r, y, x: r.times(
        r.number(2.0 / math.sqrt(math.pi)), r.step("exp", r.negative(r.power(x, 2)))
    ),
    "absolute": lambda r, y, x: r.step("side", x),
    "side": lambda r, y, x: r.step("kink", x),
    "step": lambda r, y, x: r.step("kink", x),
    "signum": lambda r, y, x: r.step("jump", x),
    "unit_step": lambda r, y, x: r.step("jump", x),
    "floor": lambda r, y, x: r.step("tread", x),
    "kink": lambda r, y, x: y,
    "jump": lambda r, y, x: y,
    "tread": lambda r, y, x: y,
    "bessel_0": lambda r, y, x: r.negative(r.step("bessel_1", x)),
    "bessel_1": lambda r, y, x: r.times(
        r.number(1.0 / 3.0),
        r.minus(r.step("bessel_0", x), r.times(r.number(2.0), r.step("bessel_2", x))),
    ),
}
"""Slopes of functions of one number from their value y and their argument x."""
