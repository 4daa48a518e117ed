"""A tape: a straight-line program of numpy operations, for points and for intervals.

        slots:  | u | v | constants ... | registers ... |
        sine:   slots[target] = sin(slots[a])

Every instruction writes one register and reads slots. Points are worked off in blocks that
stay in the processor's cache. The same instructions run on intervals give bounds over whole
cells of the (u, v) plane. A tape holds names and numbers only: it can be pickled, and nothing
in it is ever compiled or executed as Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from surfmesh.geometry.formulas import interval

BLOCK = 2048  # points at a time: a register is 16 kB, a dozen of them fit the second cache


Slot = np.ndarray | np.float64 | float


class Operation(NamedTuple):
    """One kind of instruction: on arrays, `point(*operands, out=...)`; on intervals, `bounds`."""

    point: Callable
    bounds: Callable


class Instruction(NamedTuple):
    """`slots[target] = OPERATIONS[operation](slots[operands]...)`."""

    operation: str
    target: int
    operands: tuple[int, ...]
    exponent: int = 0  # for "integer_power" only


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


def _error_function(x: Slot) -> Any:
    from scipy.special import erf  # heavy, and few formulas have it

    return erf(x)


def _erf(x: Slot, out: np.ndarray) -> None:
    out[...] = _error_function(x)


def _bessel(order: int) -> Callable[[Slot], np.ndarray]:
    """The spherical Bessel function of an order, for either sign of x."""

    def values(x: Slot) -> np.ndarray:
        from scipy.special import spherical_jn

        sign = 1.0 if order % 2 == 0 else np.where(np.asarray(x) < 0.0, -1.0, 1.0)
        return sign * spherical_jn(order, np.abs(x))

    return values


def _bessel_operation(order: int, lowest: float, highest: float) -> Operation:
    values = _bessel(order)

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
    "erf": Operation(_erf, interval.increasing(_error_function)),
    "absolute": Operation(np.absolute, interval.absolute),
    "signum": Operation(np.sign, interval.increasing(np.sign)),
    "unit_step": Operation(_step, interval.step),
    "floor": Operation(np.floor, interval.increasing(np.floor)),
    "chosen": Operation(_chosen, interval.chosen),
    "turn": Operation(np.arctan2, interval.turn),
    "bessel_0": _bessel_operation(0, -0.2173, 1.0),
    "bessel_1": _bessel_operation(1, -0.4362, 0.4362),
    "bessel_2": _bessel_operation(2, -0.1396, 0.3069),
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


class Tape(NamedTuple):
    """A program that takes `inputs` numbers a point and gives `len(outputs)` numbers a point.

    Slots are numbered inputs first, then constants, then registers.
    """

    inputs: int
    constants: tuple[float, ...]
    instructions: tuple[Instruction, ...]
    registers: int
    outputs: tuple[int, ...]

    def check(self) -> str:
        """The first broken invariant in words, or "" when all hold."""
        fixed = self.inputs + len(self.constants)
        written = set(range(fixed))
        for number, step in enumerate(self.instructions):
            if not set(step.operands) <= written:
                return f"instruction {number} reads a register before it is written"
            if not fixed <= step.target < fixed + self.registers:
                return f"instruction {number} writes outside the registers"
            if step.operation == "integer_power" and step.target in step.operands:
                return f"instruction {number} overwrites the base of a power"
            written.add(step.target)
        return "" if set(self.outputs) <= written else "an output is never written"

    def evaluate(self, points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Values at points: (n, inputs) float -> len(outputs)/3 arrays (n, 3) float.

        What is undefined comes out as nan or infinity, without a warning.
        """
        points = np.asarray(points, dtype=float)
        count = len(points)
        results = tuple(np.empty((count, 3)) for _ in range(len(self.outputs) // 3))
        memory = np.empty((self.inputs + self.registers, min(count, BLOCK)))
        with np.errstate(all="ignore"):
            for start in range(0, count, BLOCK):
                block = points[start : start + BLOCK]
                slots = self._slots(memory[:, : len(block)])
                for column in range(self.inputs):
                    slots[column][:] = block[:, column]
                for operation, target, operands, exponent in self.instructions:
                    values = [slots[operand] for operand in operands]
                    if exponent:
                        values.append(exponent)
                    OPERATIONS[operation].point(*values, out=slots[target])
                for place, slot in enumerate(self.outputs):
                    results[place // 3][start : start + BLOCK, place % 3] = slots[slot]
        return results

    def bounds(
        self, lo: np.ndarray, hi: np.ndarray, kinks: bool = True
    ) -> tuple[np.ndarray, np.ndarray]:
        """Bounds over cells: lo, hi (n, inputs) float -> lower, upper (n, len(outputs)) float.

        Every value of the function in the cell lies between them, wherever it is defined;
        infinite where nothing is known. kinks: False leaves out what second derivatives are
        across kinks, infinite.
        """
        lo, hi = np.asarray(lo, dtype=float), np.asarray(hi, dtype=float)
        count = len(lo)
        lower, upper = np.empty((count, len(self.outputs))), np.empty((count, len(self.outputs)))
        with np.errstate(all="ignore"):
            for start in range(0, count, BLOCK):
                part = slice(start, start + BLOCK)
                slots: list[interval.Interval] = [
                    (lo[part, k], hi[part, k]) for k in range(self.inputs)
                ]
                slots += [(constant, constant) for constant in map(np.float64, self.constants)]
                nothing = np.zeros(len(lo[part]))
                slots += [(nothing, nothing)] * self.registers  # each is written before it is read
                for operation, target, operands, exponent in self.instructions:
                    values = [slots[operand] for operand in operands]
                    if operation == "kink" and not kinks:
                        slots[target] = (nothing, nothing)
                    elif exponent:
                        slots[target] = OPERATIONS[operation].bounds(*values, exponent)
                    else:
                        slots[target] = OPERATIONS[operation].bounds(*values)
                for place, slot in enumerate(self.outputs):
                    lower[part, place], upper[part, place] = slots[slot]
        # outwards by more than the round-off of a tape of ordinary length
        margin = 1e-13 * np.maximum(np.abs(lower), np.abs(upper))
        margin[~np.isfinite(margin)] = 0.0
        return lower - margin, upper + margin

    def _slots(self, memory: np.ndarray) -> list:
        return [*memory[: self.inputs], *self.constants, *memory[self.inputs :]]
