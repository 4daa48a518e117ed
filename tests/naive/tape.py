"""The slow twin of the core's tapes: numpy's functions, one instruction after the other."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.special import erf, spherical_jn

from naive import interval
from surfmesh.geometry.formulas.tape import Tape

Slot = np.ndarray | np.float64 | float


class Operation(NamedTuple):
    """One kind of instruction: on arrays, `point(*operands, out=...)`; on intervals, `bounds`."""

    point: Callable
    bounds: Callable


def integer_power(x: Slot, n: int, out: np.ndarray) -> None:
    """x**n for n >= 2 by repeated multiplication, bit by bit from the top; `out` is not `x`."""
    bits = bin(n)[3:]
    np.multiply(x, x, out=out)
    if bits[0] == "1":
        np.multiply(out, x, out=out)
    for bit in bits[1:]:
        np.multiply(out, out, out=out)
        if bit == "1":
            np.multiply(out, x, out=out)


def _step(x: Slot, out: np.ndarray) -> None:
    np.heaviside(x, 0.5, out=out)


def _zero(*operands: Slot, out: np.ndarray) -> None:
    out[...] = 0.0


def _chosen(d: Slot, a: Slot, b: Slot, out: np.ndarray) -> None:
    out[...] = np.where(np.asarray(d) >= 0.0, a, b)


def _erf(x: Slot, out: np.ndarray) -> None:
    out[...] = erf(x)


def _bessel(order: int, lowest: float, highest: float) -> Operation:
    """The spherical Bessel function of an order, for either sign of x."""

    def values(x: Slot) -> np.ndarray:
        sign = 1.0 if order % 2 == 0 else np.where(np.asarray(x) < 0.0, -1.0, 1.0)
        return sign * spherical_jn(order, np.abs(x))

    def point(x: Slot, out: np.ndarray) -> None:
        out[...] = values(x)

    # the steepest slope of all is that of j0: 0.4362
    return Operation(point, interval.steady(values, 0.44, lowest, highest))


OPERATIONS: dict[str, Operation] = {
    "add": Operation(np.add, interval.add),
    "subtract": Operation(np.subtract, interval.subtract),
    "multiply": Operation(np.multiply, interval.multiply),
    "divide": Operation(np.divide, interval.divide),
    "negative": Operation(np.negative, interval.negative),
    "reciprocal": Operation(np.reciprocal, interval.reciprocal),
    "integer_power": Operation(integer_power, interval.integer_power),
    "power": Operation(np.power, interval.power),
    "sqrt": Operation(np.sqrt, interval.sqrt),
    "cube_root": Operation(np.cbrt, interval.increasing(np.cbrt)),
    "exp": Operation(np.exp, interval.exp),
    "log": Operation(np.log, interval.log),
    "sin": Operation(np.sin, interval.sin),
    "cos": Operation(np.cos, interval.cos),
    "tan": Operation(np.tan, interval.tan),
    "asin": Operation(np.arcsin, interval.asin),
    "acos": Operation(np.arccos, interval.acos),
    "atan": Operation(np.arctan, interval.increasing(np.arctan)),
    "angle": Operation(np.arctan2, interval.angle),
    "sinh": Operation(np.sinh, interval.increasing(np.sinh)),
    "cosh": Operation(np.cosh, interval.cosh),
    "tanh": Operation(np.tanh, interval.increasing(np.tanh)),
    "asinh": Operation(np.arcsinh, interval.increasing(np.arcsinh)),
    "acosh": Operation(np.arccosh, interval.acosh),
    "atanh": Operation(np.arctanh, interval.atanh),
    "erf": Operation(_erf, interval.increasing(erf)),
    "absolute": Operation(np.absolute, interval.absolute),
    "signum": Operation(np.sign, interval.increasing(np.sign)),
    "unit_step": Operation(_step, interval.step),
    "floor": Operation(np.floor, interval.increasing(np.floor)),
    "chosen": Operation(_chosen, interval.chosen),
    "turn": Operation(np.arctan2, interval.turn),
    "bessel_0": _bessel(0, -0.2173, 1.0),
    "bessel_1": _bessel(1, -0.4362, 0.4362),
    "bessel_2": _bessel(2, -0.1396, 0.3069),
    # slopes, and what they hold where they break off
    "step": Operation(_step, interval.slope_step),
    "side": Operation(np.sign, interval.slope_side),
    "kink": Operation(_zero, interval.kink),
    "jump": Operation(_zero, interval.jump),
    "tread": Operation(_zero, interval.tread),
    "cut": Operation(_zero, interval.cut),
    "minimum": Operation(np.minimum, interval.minimum),
    "maximum": Operation(np.maximum, interval.maximum),
}


def evaluate(tape: Tape, points: np.ndarray) -> tuple[np.ndarray, ...]:
    """Values at points: (n, inputs) float -> len(outputs)/3 arrays (n, 3) float."""
    count = len(points)
    slots: list[Any] = [*points.T, *(np.full(count, c) for c in tape.constants)]
    slots += [np.empty(count) for _ in range(tape.registers)]
    with np.errstate(all="ignore"):
        for operation, target, operands, exponent in tape.instructions:
            values = [slots[operand] for operand in operands] + [exponent] * bool(exponent)
            OPERATIONS[operation].point(*values, out=slots[target])
    outputs = np.stack([slots[slot] for slot in tape.outputs], axis=1)
    return tuple(outputs[:, k : k + 3] for k in range(0, len(tape.outputs), 3))


def bounds(
    tape: Tape, lo: np.ndarray, hi: np.ndarray, kinks: bool = True
) -> tuple[np.ndarray, np.ndarray]:
    """Bounds over cells: lo, hi (n, inputs) float -> lower, upper (n, len(outputs)) float."""
    nothing = np.zeros(len(lo))
    slots: list[interval.Interval] = list(zip(lo.T, hi.T))
    slots += [(nothing + constant, nothing + constant) for constant in tape.constants]
    slots += [(nothing, nothing)] * tape.registers
    with np.errstate(all="ignore"):
        for operation, target, operands, exponent in tape.instructions:
            values = [slots[operand] for operand in operands] + [exponent] * bool(exponent)
            if operation == "kink" and not kinks:
                slots[target] = (nothing, nothing)
            else:
                slots[target] = OPERATIONS[operation].bounds(*values)
    lower, upper = (np.stack([slots[s][end] for s in tape.outputs], axis=1) for end in (0, 1))
    size = np.maximum(np.abs(lower), np.abs(upper))
    finite = np.where(np.isfinite(lower), np.abs(lower), np.abs(upper))
    size = np.where(np.isfinite(size), size, finite)
    margin = np.where(np.isfinite(size), 1e-13 * size, 0.0)
    return lower - margin, upper + margin
