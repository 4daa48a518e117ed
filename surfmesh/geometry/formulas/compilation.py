"""From SymPy expressions to a tape, with derivatives.

Formulas of ordinary length are differentiated by SymPy, which brings them into short forms;
its time grows faster than their length, so that long ones are differentiated as programs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from surfmesh.geometry.formulas import real_functions
from surfmesh.geometry.formulas.chain_rule import derivatives
from surfmesh.geometry.formulas.derivatives import Definitions
from surfmesh.geometry.formulas.program import Program
from surfmesh.geometry.formulas.tape import Tape

MOST_GUIDES = 32  # functions whose zeros are looked for
ORDINARY = 50  # operations of formulas that SymPy differentiates in half a second


def surface_tape(
    coordinates: Sequence[sp.Expr], variables: Sequence[sp.Symbol], order: int
) -> Tape:
    """The tape of r (order 0), with r_u, r_v (order 1), with r_uu, r_uv, r_vv (order 2).

    coordinates: x, y, z in the two variables. Outputs: three numbers for each of these.
    """
    long = operations(coordinates) > ORDINARY
    return (long_surface_tape if long else by_definitions)(coordinates, variables, order)


def by_definitions(
    coordinates: Sequence[sp.Expr], variables: Sequence[sp.Symbol], order: int
) -> Tape:
    """The same, differentiated by SymPy."""
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


def operations(expressions: Sequence[sp.Expr]) -> int:
    """How many sums, products, powers and functions there are in expressions, repeated or not."""
    parts = (part for expression in expressions for part in sp.preorder_traversal(expression))
    return sum(bool(part.args) for part in parts)


def long_surface_tape(
    coordinates: Sequence[sp.Expr], variables: Sequence[sp.Symbol], order: int
) -> Tape:
    """The same, differentiated step by step."""
    program = Program(variables, {})
    r = [program.value(coordinate) for coordinate in coordinates]
    outputs = list(r)
    if order >= 1:
        r_u, r_v = derivatives(program, r, 0), derivatives(program, r, 1)
        outputs += r_u + r_v
    if order >= 2:
        outputs += derivatives(program, r_u, 0)
        outputs += derivatives(program, r_u, 1) + derivatives(program, r_v, 1)
    return program.tape(outputs)


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
    if operations(list(found)) > ORDINARY:
        program = Program(variables, {})
        values = [program.value(guide) for guide in found]
        slopes = [derivatives(program, values, variable) for variable in (0, 1)]
        return program.tape([value for guide in zip(values, *slopes) for value in guide])
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
    program = Program(variables, meaning or {})
    return program.tape([program.value(expression) for expression in expressions])
