"""Straight-line programs: values numbered by what computes them, constants folded, and from
them a tape, whose registers are used again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from surfmesh.errors import SurfaceError
from surfmesh.geometry.formulas import real_functions
from surfmesh.geometry.formulas.tape import Instruction, Tape, result_of

# the operation behind each function that may stand in an expression
FUNCTION_OPERATIONS: dict[type, str] = {
    sp.sin: "sin",
    sp.cos: "cos",
    sp.tan: "tan",
    sp.asin: "asin",
    sp.acos: "acos",
    sp.atan: "atan",
    sp.sinh: "sinh",
    sp.cosh: "cosh",
    sp.tanh: "tanh",
    sp.asinh: "asinh",
    sp.acosh: "acosh",
    sp.atanh: "atanh",
    sp.exp: "exp",
    sp.log: "log",
    sp.erf: "erf",
    real_functions.absolute: "absolute",
    real_functions.signum: "signum",
    real_functions.side: "side",
    real_functions.step: "step",
    real_functions.unit_step: "unit_step",
    real_functions.integer_part: "floor",
    real_functions.chosen: "chosen",
    real_functions.kink: "kink",
    real_functions.jump: "jump",
    real_functions.tread: "tread",
    real_functions.cut: "cut",
    real_functions.turn: "turn",
    real_functions.sinc: "bessel_0",
    real_functions.sinc_1: "bessel_1",
    real_functions.sinc_2: "bessel_2",
    real_functions.minimum: "minimum",
    real_functions.maximum: "maximum",
    real_functions.cube_root: "cube_root",
    real_functions.angle: "angle",
}
LARGEST_POWER = 64  # by repeated multiplication; above it numpy's power is no slower


class Program:
    """Values numbered by what computes them, so that equal computations are done once.

    Values 0, 1, ... are the inputs and then the results of `steps`; -1, -2, ... are constants.
    """

    def __init__(self, variables: Sequence[sp.Symbol], meaning: Mapping) -> None:
        self.inputs = len(variables)
        self.constants: list[float] = []  # value -1 - i is constants[i]
        self.steps: list[tuple[str, tuple[int, ...], int]] = []  # value inputs + i is steps[i]
        self._meaning = meaning
        self._by_constant: dict[float, int] = {}
        self._by_step: dict[tuple, int] = {}
        self._by_expression = {variable: number for number, variable in enumerate(variables)}
        self.one, self.minus_one = self.constant(1.0), self.constant(-1.0)

    def value(self, expression: sp.Expr) -> int:
        found = self._by_expression.get(expression)
        if found is None:
            found = self._by_expression[expression] = self._new_value(expression)
        return found

    def _new_value(self, expression: sp.Expr) -> int:
        if expression.is_Symbol:
            return self.value(self._meaning[expression])
        if expression.is_Number or expression.is_NumberSymbol:
            return self.constant(float(expression))
        if expression.is_Add:
            return self._sum(expression)
        if expression.is_Mul:
            return self._product(expression)
        if expression.is_Pow:
            return self._power(expression.base, expression.exp)
        operation = FUNCTION_OPERATIONS.get(expression.func)
        if operation is None:
            raise SurfaceError(f"{expression.func} cannot be evaluated in a formula")
        return self.step(operation, *(self.value(part) for part in expression.args))

    def _sum(self, expression: sp.Expr) -> int:
        plus, minus = [], []
        for term in expression.args:
            coefficient, rest = term.as_coeff_Mul()
            if coefficient.is_negative:
                minus.append(self.value(-coefficient * rest))
            else:
                plus.append(self.value(term))
        if not plus:
            return self.step("negative", self._folded("add", minus))
        total = self._folded("add", plus)
        for value in sorted(minus):
            total = self.step("subtract", total, value)
        return total

    def _product(self, expression: sp.Expr) -> int:
        above, below = [], []
        for factor in expression.args:
            if factor.is_Pow and factor.exp.is_Rational and factor.exp.is_negative:
                below.append(self._power(factor.base, -factor.exp))
            else:
                above.append(self.value(factor))
        negated = self.minus_one in above
        if negated:
            above.remove(self.minus_one)
        product = self._folded("multiply", above) if above else self.one
        if below:
            product = self.step("divide", product, self._folded("multiply", below))
        return self.step("negative", product) if negated else product

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> int:
        value = self.value(base)
        if exponent.is_Integer and 0 < exponent <= LARGEST_POWER:
            return self.step("integer_power", value, exponent=int(exponent))
        if exponent == sp.S.Half:
            return self.step("sqrt", value)
        if exponent.is_Rational and exponent.is_negative:
            return self.step("divide", self.one, self._power(base, -exponent))
        if exponent.is_Rational and exponent.q == 2 and exponent.p <= LARGEST_POWER:
            return self.step("integer_power", self.step("sqrt", value), exponent=int(exponent.p))
        return self.step("power", value, self.value(exponent))

    def _folded(self, operation: str, values: list[int]) -> int:
        """Many values put together by an operation whose order does not matter."""
        first, *others = sorted(values)
        for value in others:
            first = self.step(operation, first, value)
        return first

    def step(self, operation: str, *operands: int, exponent: int = 0) -> int:
        if exponent == 1:
            return operands[0]
        if operation == "multiply" and operands[0] == self.one:
            return operands[1]
        if operation == "divide" and operands[0] == self.one:
            operation, operands = "reciprocal", operands[1:]
        if max(operands) < 0:
            return self.constant(self._result(operation, operands, exponent))
        key = (operation, operands, exponent)
        if key not in self._by_step:
            self._by_step[key] = self.inputs + len(self.steps)
            self.steps.append(key)
        return self._by_step[key]

    def constant(self, number: float) -> int:
        if number not in self._by_constant:
            self.constants.append(number)
            self._by_constant[number] = -len(self.constants)
        return self._by_constant[number]

    def _result(self, operation: str, operands: tuple[int, ...], exponent: int) -> float:
        return result_of(
            operation, [self.constants[-1 - operand] for operand in operands], exponent
        )

    def tape(self, outputs: list[int]) -> Tape:
        """Values become slots; a register is free again after the last step that reads it."""
        last_use: dict[int, int] = {}
        for number, (_, operands, _) in enumerate(self.steps):
            last_use.update((operand, number) for operand in operands)
        last_use.update((output, len(self.steps)) for output in outputs)

        constants = sorted(value for value in last_use if value < 0)
        slot = {number: number for number in range(self.inputs)}
        slot |= {value: self.inputs + place for place, value in enumerate(constants)}
        first_register = self.inputs + len(constants)

        free: list[int] = []
        registers = 0
        instructions = []
        for number, (operation, operands, exponent) in enumerate(self.steps):
            result = self.inputs + number
            if free:
                slot[result] = free.pop()
            else:
                slot[result] = first_register + registers
                registers += 1
            # the target is taken before the operands are freed: a power may not overwrite its base
            places = tuple(slot[operand] for operand in operands)
            instructions.append(Instruction(operation, slot[result], places, exponent))
            dead = {x for x in operands if x >= self.inputs and last_use[x] == number}
            free += [slot[x] for x in sorted(dead)]
            if result not in last_use:
                free.append(slot[result])
        return Tape(
            self.inputs,
            tuple(self.constants[-1 - value] for value in constants),
            tuple(instructions),
            registers,
            tuple(slot[output] for output in outputs),
        )
