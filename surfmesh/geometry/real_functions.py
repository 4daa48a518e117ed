"""Functions of real variables for SymPy, differentiable almost everywhere.

SymPy's own Abs, sign, Min, Max, cbrt and atan2 are made for the complex plane: their
derivatives hold re, im, DiracDelta, and comparing large constants can take for ever. These
stay unevaluated and have the derivative that holds almost everywhere.
"""

from __future__ import annotations

import sympy as sp


class absolute(sp.Function):
    """|x|; derivative sign(x)."""

    nargs = 1

    def fdiff(self, argindex=1):
        return signum(self.args[0])


class signum(sp.Function):
    """-1, 0 or 1; derivative 0."""

    nargs = 1

    def fdiff(self, argindex=1):
        return sp.S.Zero


class step(sp.Function):
    """0 for x < 0, 1/2 at 0, 1 for x > 0; derivative 0."""

    nargs = 1

    def fdiff(self, argindex=1):
        return sp.S.Zero


class minimum(sp.Function):
    """The smaller of two; where they are equal the derivative is the mean of both."""

    nargs = 2

    def fdiff(self, argindex=1):
        a, b = self.args
        return step(b - a) if argindex == 1 else step(a - b)


class maximum(sp.Function):
    """The larger of two; where they are equal the derivative is the mean of both."""

    nargs = 2

    def fdiff(self, argindex=1):
        a, b = self.args
        return step(a - b) if argindex == 1 else step(b - a)


class cube_root(sp.Function):
    """The real cube root, also of negative numbers."""

    nargs = 1

    def fdiff(self, argindex=1):
        return 1 / (3 * self**2)


class angle(sp.Function):
    """atan2(y, x), the angle of the point (x, y)."""

    nargs = 2

    def fdiff(self, argindex=1):
        y, x = self.args
        return (x if argindex == 1 else -y) / (x**2 + y**2)


def on_the_real_line(expression: sp.Expr) -> sp.Expr:
    """SymPy's complex functions replaced by the real ones above, and sec, csc, cot by ratios."""
    if not expression.has(sp.Abs, sp.sign, sp.Min, sp.Max, sp.atan2, sp.sec, sp.csc, sp.cot):
        return expression
    expression = expression.replace(sp.Abs, absolute).replace(sp.sign, signum)
    expression = expression.replace(sp.Min, lambda *xs: folded(minimum, xs))
    expression = expression.replace(sp.Max, lambda *xs: folded(maximum, xs))
    expression = expression.replace(sp.atan2, angle)
    expression = expression.replace(sp.sec, lambda x: 1 / sp.cos(x))
    expression = expression.replace(sp.csc, lambda x: 1 / sp.sin(x))
    return expression.replace(sp.cot, lambda x: sp.cos(x) / sp.sin(x))


def folded(pair, arguments):
    """A function of two applied to many, from the left."""
    result = arguments[0]
    for argument in arguments[1:]:
        result = pair(result, argument)
    return result
