"""From SymPy expressions to a tape: shared subexpressions, constants folded, registers reused."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp

from surfmesh.errors import SurfaceError
from surfmesh.geometry import real_functions
from surfmesh.geometry.derivatives import Definitions
from surfmesh.geometry.tape import OPERATIONS, Instruction, Tape, integer_power

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
MOST_GUIDES = 32  # functions whose zeros are looked for
LARGEST_POWER = 64  # by repeated multiplication; above it numpy's power is no slower


def surface_tape(
    coordinates: Sequence[sp.Expr], variables: Sequence[sp.Symbol], order: int
) -> Tape:
    """The tape of r (order 0), with r_u, r_v (order 1), with r_uu, r_uv, r_vv (order 2).

    coordinates: x, y, z in the two variables. Outputs: three numbers for each of these.
    """
    u, v = variables
    definitions = Definitions(variables)
    r = [definitions.shortened(coordinate) for coordinate in coordinates]
    outputs = list(r)
    if order >= 1:
        r_u = [definitions.derivative(c, u) for c in r]
        r_v = [definitions.derivative(c, v) for c in r]
        outputs += r_u + r_v
    if order >= 2:
        outputs += [definitions.derivative(c, u) for c in r_u]
        outputs += [definitions.derivative(c, v) for c in r_u]
        outputs += [definitions.derivative(c, v) for c in r_v]
    names = list(definitions.meaning)
    shared, reduced = sp.cse(outputs + [definitions.meaning[name] for name in names])
    meaning = dict(shared) | dict(zip(names, reduced[len(outputs) :]))
    return compiled(reduced[: len(outputs)], variables, meaning)


def guide_tape(coordinates: Sequence[sp.Expr], variables: Sequence[sp.Symbol]) -> Tape | None:
    """The tape of the functions whose zeros are kinks or jumps of r, each with d/du and d/dv.

    None without any. Products are taken apart; what differs by a factor is taken once.
    """
    found: dict[sp.Expr, None] = {}
    for coordinate in coordinates:
        for part in sp.preorder_traversal(coordinate):
            for guide in real_functions.guides(part):
                for factor in sp.Mul.make_args(guide):
                    base = factor.base if factor.is_Pow else factor
                    base = base.primitive()[1] if base.is_Add else base.as_coeff_Mul()[1]
                    if base.free_symbols and base not in found and -base not in found:
                        found[base] = None
    if not found or len(found) > MOST_GUIDES:
        return None
    u, v = variables
    definitions = Definitions(variables)
    outputs = []
    for guide in found:
        short = definitions.shortened(guide)
        outputs += [short, definitions.derivative(short, u), definitions.derivative(short, v)]
    return compiled(outputs, variables, definitions.meaning)


def roots_of_one_parameter(
    coordinates: Sequence[sp.Expr], variables: Sequence[sp.Symbol]
) -> list[tuple[int, Tape]]:
    """Functions of one parameter alone whose roots below one are taken: number of the parameter
    and tape. Where they vanish the speed may have no bound: cbrt(u), sign(u) sqrt(abs(u))."""
    found: dict[sp.Expr, int] = {}
    for coordinate in coordinates:
        for part in sp.preorder_traversal(coordinate):
            base = real_functions.rooted(part)
            if base is not None and len(base.free_symbols) == 1:
                (symbol,) = base.free_symbols
                if symbol in variables:
                    found[base] = variables.index(symbol)
    # a tape has three outputs for each vector: the function, thrice
    return [(axis, compiled([base] * 3, variables)) for base, axis in found.items()]


def compiled(
    expressions: Sequence[sp.Expr],
    variables: Sequence[sp.Symbol],
    meaning: Mapping[sp.Symbol, sp.Expr] | None = None,
) -> Tape:
    """A tape that evaluates expressions; `meaning` defines further names used in them.

    Raises SurfaceError for a function that has no operation.
    """
    program = _Program(variables, meaning or {})
    return program.tape([program.value(expression) for expression in expressions])


class _Program:
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
        self._one, self._minus_one = self._constant(1.0), self._constant(-1.0)

    def value(self, expression: sp.Expr) -> int:
        found = self._by_expression.get(expression)
        if found is None:
            found = self._by_expression[expression] = self._new_value(expression)
        return found

    def _new_value(self, expression: sp.Expr) -> int:
        if expression.is_Symbol:
            return self.value(self._meaning[expression])
        if expression.is_Number or expression.is_NumberSymbol:
            return self._constant(float(expression))
        if expression.is_Add:
            return self._sum(expression)
        if expression.is_Mul:
            return self._product(expression)
        if expression.is_Pow:
            return self._power(expression.base, expression.exp)
        operation = FUNCTION_OPERATIONS.get(expression.func)
        if operation is None:
            raise SurfaceError(f"{expression.func} cannot be evaluated in a formula")
        return self._step(operation, *(self.value(part) for part in expression.args))

    def _sum(self, expression: sp.Expr) -> int:
        plus, minus = [], []
        for term in expression.args:
            coefficient, rest = term.as_coeff_Mul()
            if coefficient.is_negative:
                minus.append(self.value(-coefficient * rest))
            else:
                plus.append(self.value(term))
        if not plus:
            return self._step("negative", self._folded("add", minus))
        total = self._folded("add", plus)
        for value in sorted(minus):
            total = self._step("subtract", total, value)
        return total

    def _product(self, expression: sp.Expr) -> int:
        above, below = [], []
        for factor in expression.args:
            if factor.is_Pow and factor.exp.is_Rational and factor.exp.is_negative:
                below.append(self._power(factor.base, -factor.exp))
            else:
                above.append(self.value(factor))
        negated = self._minus_one in above
        if negated:
            above.remove(self._minus_one)
        product = self._folded("multiply", above) if above else self._one
        if below:
            product = self._step("divide", product, self._folded("multiply", below))
        return self._step("negative", product) if negated else product

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> int:
        value = self.value(base)
        if exponent.is_Integer and 0 < exponent <= LARGEST_POWER:
            return self._step("integer_power", value, exponent=int(exponent))
        if exponent == sp.S.Half:
            return self._step("sqrt", value)
        if exponent.is_Rational and exponent.is_negative:
            return self._step("divide", self._one, self._power(base, -exponent))
        if exponent.is_Rational and exponent.q == 2 and exponent.p <= LARGEST_POWER:
            return self._step("integer_power", self._step("sqrt", value), exponent=int(exponent.p))
        return self._step("power", value, self.value(exponent))

    def _folded(self, operation: str, values: list[int]) -> int:
        """Many values put together by an operation whose order does not matter."""
        first, *others = sorted(values)
        for value in others:
            first = self._step(operation, first, value)
        return first

    def _step(self, operation: str, *operands: int, exponent: int = 0) -> int:
        if exponent == 1:
            return operands[0]
        if operation == "multiply" and operands[0] == self._one:
            return operands[1]
        if operation == "divide" and operands[0] == self._one:
            operation, operands = "reciprocal", operands[1:]
        if max(operands) < 0:
            return self._constant(self._result(operation, operands, exponent))
        key = (operation, operands, exponent)
        if key not in self._by_step:
            self._by_step[key] = self.inputs + len(self.steps)
            self.steps.append(key)
        return self._by_step[key]

    def _constant(self, number: float) -> int:
        if number not in self._by_constant:
            self.constants.append(number)
            self._by_constant[number] = -len(self.constants)
        return self._by_constant[number]

    def _result(self, operation: str, operands: tuple[int, ...], exponent: int) -> float:
        arguments = [np.array([self.constants[-1 - operand]]) for operand in operands]
        result = np.empty(1)
        with np.errstate(all="ignore"):
            if exponent:
                integer_power(arguments[0], exponent, out=result)
            else:
                OPERATIONS[operation].point(*arguments, out=result)
        return float(result[0])

    def tape(self, outputs: list[int]) -> Tape:
        """Values become slots; a register is free again after the last step that reads it."""
        last_use = {}
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
