"""Partial derivatives of formulas by the chain rule over shared subexpressions.

Long formulas are first cut into short definitions,

        z = (u + 3 v)^2 exp(1 - u^2 - v^2)   ->   t0 = u + 3 v,  t1 = ...,  z = t0^2 t1,

and SymPy differentiates one definition at a time with respect to u, v and the names it uses.
The work then grows with the length of the formula; differentiated in one piece, a product
of n factors would grow as n^3.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

SHORT = 24  # operations that a formula may have before it is cut
FEW = 6  # terms or factors that a sum or product may have before it is cut


class Definitions:
    """Names for subexpressions, and the derivatives of what they stand for.

    `meaning[name]` is an expression in u, v and earlier names.
    """

    def __init__(self, variables: Sequence[sp.Symbol]) -> None:
        self.variables = tuple(variables)
        self.meaning: dict[sp.Symbol, sp.Expr] = {}
        self._cut: dict[sp.Expr, tuple[sp.Expr, int]] = {}
        self._rates: dict[tuple[sp.Symbol, sp.Symbol], sp.Expr] = {}

    def shortened(self, expression: sp.Expr) -> sp.Expr:
        """An equal expression in which every long part is a name."""
        return self._shortened(expression)[0]

    def derivative(self, expression: sp.Expr, variable: sp.Symbol) -> sp.Expr:
        """d expression / d variable, through the names that it uses."""
        total = sp.diff(expression, variable)
        for name in sorted(expression.free_symbols & self.meaning.keys(), key=_age):
            rate = self._rate(name, variable)
            if rate is not sp.S.Zero:
                total += sp.diff(expression, name) * rate
        return self.shortened(total)

    def _rate(self, name: sp.Symbol, variable: sp.Symbol) -> sp.Expr:
        """The derivative of a name, kept: a short expression or another name."""
        key = (name, variable)
        if key not in self._rates:
            rate = self.derivative(self.meaning[name], variable)
            self._rates[key] = rate if rate.is_Atom else self._named(rate)
        return self._rates[key]

    def _shortened(self, expression: sp.Expr) -> tuple[sp.Expr, int]:
        """The shortened expression and the number of operations left in it."""
        if expression.is_Atom:
            return expression, 0
        if expression in self._cut:
            return self._cut[expression]
        parts = [self._shortened(part) for part in expression.args]
        if expression.is_Add or expression.is_Mul:
            while len(parts) > FEW:  # pairs, and pairs of pairs: a balanced tree of names
                pairs = zip(parts[::2], parts[1::2])
                odd = parts[-1:] if len(parts) % 2 else []
                parts = [(self._named(expression.func(a[0], b[0])), 0) for a, b in pairs] + odd
        size = len(parts) - (len(parts) > 1) + sum(count for _, count in parts)
        if all(part is argument for (part, _), argument in zip(parts, expression.args)):
            result = expression
        else:
            result = expression.func(*(part for part, _ in parts))
        if size > SHORT:
            result, size = self._named(result), 0
        self._cut[expression] = result, size
        return result, size

    def _named(self, expression: sp.Expr) -> sp.Expr:
        if expression.is_Atom:
            return expression
        name = sp.Dummy(f"t{len(self.meaning)}", real=True)
        self.meaning[name] = expression
        return name


def _age(name: sp.Symbol) -> int:
    return name.dummy_index
