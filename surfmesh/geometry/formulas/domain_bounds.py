"""Bounds of a domain, which may be formulas without variables."""

from __future__ import annotations

from typing import Any

from surfmesh.errors import FormulaError, SurfaceError, shown
from surfmesh.geometry.number_range import RANGE


def bounds_of(variable: str, bounds: tuple[Any, Any]) -> tuple[float, float]:
    """(first, last) of a variable as numbers; text such as "2*pi" is understood.

    Raises SurfaceError when they are not a pair in order, FormulaError for text that is refused.
    """
    try:
        first, last = bounds
    except (TypeError, ValueError):
        reason = f"the domain of {variable} is a pair (first, last), not {shown(bounds)}"
        raise SurfaceError(reason) from None
    first, last = _number(variable, first), _number(variable, last)
    if first == last:
        raise SurfaceError(f"the domain of {variable} is empty: {first:g} to {last:g}")
    if first > last:
        raise SurfaceError(f"the domain of {variable} is reversed: {first:g} to {last:g}")
    size = max(abs(first), abs(last))
    if size > RANGE.parameter or last - first < RANGE.span:
        raise SurfaceError(
            f"the domain of {variable} is {first:g} to {last:g}: numbers up to {RANGE.parameter:g} "
            f"at least {RANGE.span:g} apart can be computed with; change its unit"
        )
    if last - first < RANGE.narrow * size:
        raise SurfaceError(
            f"the domain of {variable} is {first:.17g} to {last:.17g}: too narrow to lay numbers "
            "between; move its origin"
        )
    return first, last


def _number(variable: str, bound: Any) -> float:
    from surfmesh.geometry.formulas.expression import parse_number

    try:
        return parse_number(bound)
    except FormulaError as error:
        reason = f"the domain of {variable}: {error.reason}"
        raise FormulaError(reason, error.text, error.column) from None
