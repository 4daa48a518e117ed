"""A tape: a straight-line program of elementary operations, for points and for intervals.

        slots:  | u | v | constants ... | registers ... |
        sine:   slots[target] = sin(slots[a])

Every instruction writes one register and reads slots. The core works points off in blocks that
stay in the processor's cache. The same instructions run on intervals give bounds over whole
cells of the (u, v) plane. A tape holds names and numbers only: it can be pickled, and nothing
in it is ever compiled or executed as Python.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from surfmesh._core import surfaces


class Instruction(NamedTuple):
    """`slots[target] = operation(slots[operands]...)`, one of the core's operations by name."""

    operation: str
    target: int
    operands: tuple[int, ...]
    exponent: int = 0  # for "integer_power" only


@dataclass(frozen=True)
class Tape:
    """A program that takes `inputs` numbers a point and gives `len(outputs)` numbers a point.

    Slots are numbered inputs first, then constants, then registers.
    """

    inputs: int
    constants: tuple[float, ...]
    instructions: tuple[Instruction, ...]
    registers: int
    outputs: tuple[int, ...]

    @cached_property
    def program(self) -> surfaces.Tape:
        """What runs; ValueError where an invariant is broken."""
        return surfaces.Tape(
            self.inputs, self.constants, self.instructions, self.registers, self.outputs
        )

    def broken_invariant(self) -> str:
        """The first broken invariant in words, or "" when all hold."""
        try:
            surfaces.Tape(
                self.inputs, self.constants, self.instructions, self.registers, self.outputs
            )
        except ValueError as error:
            return str(error)
        return ""

    def evaluate(self, points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Values at points: (n, inputs) float -> len(outputs)/3 arrays (n, 3) float.

        What is undefined comes out as nan or infinity, without a warning.
        """
        return tuple(self.program.evaluate(np.asarray(points, dtype=float)))

    def bounds(
        self, lo: np.ndarray, hi: np.ndarray, kinks: bool = True
    ) -> tuple[np.ndarray, np.ndarray]:
        """Bounds over cells: lo, hi (n, inputs) float -> lower, upper (n, len(outputs)) float.

        Every value of the function in the cell lies between them, wherever it is defined;
        infinite where nothing is known. kinks: False leaves out what second derivatives are
        across kinks, infinite.
        """
        lo, hi = np.asarray(lo, dtype=float), np.asarray(hi, dtype=float)
        return self.program.bounds(lo, hi, kinks)

    def __getstate__(self) -> dict[str, Any]:
        return {key: value for key, value in self.__dict__.items() if key != "program"}


def result_of(operation: str, operands: Sequence[float], exponent: int = 0) -> float:
    """One operation on numbers, as a tape does it."""
    count = len(operands)
    step = Instruction(operation, count, tuple(range(count)), exponent)
    tape = Tape(count, (), (step,), 1, (count,) * 3)
    return float(tape.evaluate(np.array([operands]))[0][0, 0])
