"""Formulas as data: text or SymPy expressions through a whitelist, nothing executed as Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from surfmesh.errors import FormulaError, shown
from surfmesh.geometry.formulas import real_functions as real
from surfmesh.geometry.formulas.function_table import known_functions
from surfmesh.geometry.formulas.parser import (
    Parser,
    as_text,
    digits_of,
    finite,
    is_number,
    number_of,
    quoted,
    rational,
    symbol,
)
from surfmesh.geometry.formulas.program import FUNCTION_OPERATIONS
from surfmesh.geometry.number_range import RANGE

DEEPEST_READY = 150  # levels of a ready-made expression, each of its operations being one
READY_DIGITS = 10_000  # binary digits of a number in it
MOST_OPERATIONS = 8_000  # of a ready-made expression, whose text may be endless

_CURE = ": give the surface as a function, a NumericSurface"


def parse(
    text: str | float | sp.Expr,
    names: Sequence[str] = ("u", "v"),
    parameters: Mapping[str, float] | None = None,
) -> sp.Expr:
    """A SymPy expression from a formula, a number or an expression that is already built.

    names: the variables; they become real symbols. parameters: named numbers, put in at once.
    Raises FormulaError with the column of what was refused.
    """
    if isinstance(text, sp.Basic):
        return _checked(text, names, parameters or {})
    return Parser(as_text(text), names, parameters or {}).formula().expression


def parse_number(text: str | float | sp.Expr) -> float:
    """A finite number from text such as "2*pi", from a number or a constant expression.

    Raises FormulaError.
    """
    if isinstance(text, sp.Basic):
        expression = _checked(text, (), {})
        return number_of(expression, str(expression), 1)
    if is_number(text):
        return finite(text)
    part = Parser(as_text(text), (), {}).formula()
    return number_of(part.expression, as_text(text), 1) if part.value is None else part.value


def _checked(expression: sp.Expr, names: Sequence[str], parameters: Mapping[str, float]) -> sp.Expr:
    """A ready-made expression over the same variables, functions and numbers as a formula."""
    if not isinstance(expression, sp.Expr):
        raise FormulaError("not a scalar expression", shown(expression))
    _refuse_endless(expression)
    text = str(expression)
    expression = real.on_the_real_line(expression)
    known = {}
    for free in expression.free_symbols:
        if free.name in names:
            known[free] = symbol(free.name)
        elif free.name in parameters:
            known[free] = rational(parameters[free.name])
        else:
            raise FormulaError(f"unknown name {quoted(free.name)}", text)
    for number in expression.atoms(sp.Float):
        if number.is_finite:
            known[number] = sp.Rational(repr(float(number)))
    expression = real.on_the_real_line(expression.xreplace(known))
    for part in sp.preorder_traversal(expression):
        allowed = part.is_Add or part.is_Mul or part.is_Pow or part.is_Symbol
        allowed |= part.is_Rational or part.is_NumberSymbol
        if not (allowed or part.func in FUNCTION_OPERATIONS):
            raise FormulaError(
                f"{quoted(str(part))} is not part of a formula{known_functions(str(part.func))}",
                text,
            )
    return expression


def _refuse_endless(expression: sp.Expr) -> None:
    """Raise FormulaError for what could not even be printed: endless, deep, or huge numbers.

    Shared parts stand there once, and in the text as often as they are used.
    """
    sizes: dict[sp.Basic, tuple[int, int]] = {}  # operations and levels
    waiting = [expression]
    while waiting:
        part = waiting[-1]
        unknown = [argument for argument in part.args if argument not in sizes]
        if unknown:
            waiting += unknown
            continue
        waiting.pop()
        known = [sizes[argument] for argument in part.args]
        operations = sum((count for count, _ in known), start=bool(known))
        levels = max((depth for _, depth in known), default=-1) + 1
        if operations > MOST_OPERATIONS:
            raise FormulaError(f"an expression of more than {MOST_OPERATIONS:,} operations{_CURE}")
        if levels > DEEPEST_READY:
            raise FormulaError(f"an expression of more than {DEEPEST_READY} levels{_CURE}")
        many = part.is_Rational and digits_of(part) > READY_DIGITS
        if many or (part.is_Number and part.is_finite and abs(part) > RANGE.constant):
            raise FormulaError("a number in the expression is too large, or has too many digits")
        sizes[part] = operations, levels
