"""Functions of real variables for SymPy, differentiable almost everywhere.

SymPy's own Abs, sign, Min, Max, cbrt and atan2 are made for the complex plane: their
derivatives hold re, im, DiracDelta, and comparing large constants can take for ever. These
stay unevaluated and have the derivative that holds almost everywhere.

Where that derivative breaks off, it holds a function that is zero at every point and has no
bounds over an interval with the break inside: ``kink`` for a second derivative (the surface is
bent there), ``jump``, ``tread`` and ``cut`` for a first one (the surface is torn there). So
no interval takes a broken function for a smooth one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import sympy as sp


class _Break(sp.Function):
    """Zero, and without bounds over intervals that hold a break; so are its derivatives."""

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return self


class kink(_Break):
    """A first derivative jumps where x = 0: no bounds where that is inside the interval."""

    nargs = 1


class jump(_Break):
    """A value jumps where x = 0: no bounds where that is in the interval or at its ends."""

    nargs = 1


class tread(_Break):
    """A value jumps where x is an integer, otherwise as ``jump``."""

    nargs = 1


class cut(_Break):
    """The angle of (y, x) jumps where y = 0, x < 0."""

    nargs = 2


class absolute(sp.Function):
    """|x|; derivative ``side(x)``."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return side(self.args[0])


class side(sp.Function):
    """The slope of |x|: -1, 0 or 1, over an interval from 0 onwards 1."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return kink(self.args[0])


class signum(sp.Function):
    """-1, 0 or 1; derivative 0."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return jump(self.args[0])


class step(sp.Function):
    """A slope: 0 for x < 0, 1/2 at 0, 1 for x > 0, over an interval from 0 onwards 1."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return kink(self.args[0])


class unit_step(sp.Function):
    """Heaviside's: 0 for x < 0, 1/2 at 0, 1 for x > 0; derivative 0."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return jump(self.args[0])


class integer_part(sp.Function):
    """floor(x); derivative 0."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return tread(self.args[0])


class chosen(sp.Function):
    """chosen(d, a, b): a where d >= 0, b elsewhere."""

    nargs = 3

    def _eval_derivative(self, variable: sp.Symbol) -> sp.Expr:
        d, a, b = self.args
        sides = a.diff(variable), b.diff(variable)
        # the side that is not chosen may be undefined: its derivative stays behind the choice
        inner = sp.S.Zero if sides == (0, 0) else chosen(d, *sides)
        return jump(d) * d.diff(variable) + inner


class minimum(sp.Function):
    """The smaller of two; where they are equal the derivative is the mean of both."""

    nargs = 2

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        a, b = self.args
        return step(b - a) if argindex == 1 else step(a - b)


class maximum(sp.Function):
    """The larger of two; where they are equal the derivative is the mean of both."""

    nargs = 2

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        a, b = self.args
        return step(a - b) if argindex == 1 else step(b - a)


class cube_root(sp.Function):
    """The real cube root, also of negative numbers."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return 1 / (3 * self**2)


class angle(sp.Function):
    """atan2(y, x), the angle of the point (x, y); torn along the negative x axis."""

    nargs = 2

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        y, x = self.args
        return (x if argindex == 1 else -y) / (x**2 + y**2) + cut(y, x)


class turn(sp.Function):
    """The same angle where only its sine, cosine or tangent matters: nothing is torn."""

    nargs = 2

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        y, x = self.args
        return (x if argindex == 1 else -y) / (x**2 + y**2)


class sinc(sp.Function):
    """sin(x) / x, 1 at 0: the spherical Bessel function j0; -j1 is its derivative."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return -sinc_1(self.args[0])


class sinc_1(sp.Function):
    """The spherical Bessel function j1; derivative (j0 - 2 j2) / 3."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        x = self.args[0]
        return (sinc(x) - 2 * sinc_2(x)) / 3


class sinc_2(sp.Function):
    """The spherical Bessel function j2."""

    nargs = 1


def rooted(part: sp.Expr) -> sp.Expr | None:
    """What a root below one is taken of: f of cbrt(f), sqrt(f), abs(f)**0.3; None: no root."""
    if isinstance(part, cube_root):
        base = part.args[0]
    elif part.is_Pow and part.exp.is_number and 0 < part.exp < 1:
        base = part.base
    else:
        return None
    return base.args[0] if isinstance(base, absolute) else base


def guides(part: sp.Expr) -> tuple[sp.Expr, ...]:
    """Functions whose zeros are kinks, jumps or infinite slopes of one node of an expression."""
    if part.func in (absolute, signum, unit_step, cube_root):
        return (part.args[0],)
    if part.func in (minimum, maximum):
        return (part.args[0] - part.args[1],)
    if part.func is angle:
        return part.args  # torn on y = 0, but only as far as x < 0
    if part.func is integer_part:
        return (sp.sin(sp.pi * part.args[0]),)
    return (part.args[0],) if part.func is chosen else ()


# what SymPy knows under its own names, as far as it is not simply the same
_REAL = {
    sp.Abs: lambda x: absolute(x),
    sp.sign: lambda x: signum(x),
    sp.Min: lambda *xs: folded(minimum, xs),
    sp.Max: lambda *xs: folded(maximum, xs),
    sp.atan2: lambda y, x: angle(y, x),
    sp.Heaviside: lambda x, *at_zero: unit_step(x),
    sp.floor: lambda x: integer_part(x),
    sp.ceiling: lambda x: -integer_part(-x),
    sp.frac: lambda x: x - integer_part(x),
    sp.sinc: lambda x: sinc(x),
    sp.erfc: lambda x: 1 - sp.erf(x),
    sp.sec: lambda x: 1 / sp.cos(x),
    sp.csc: lambda x: 1 / sp.sin(x),
    sp.cot: lambda x: sp.cos(x) / sp.sin(x),
    sp.sech: lambda x: 1 / sp.cosh(x),
    sp.csch: lambda x: 1 / sp.sinh(x),
    sp.coth: lambda x: 1 / sp.tanh(x),
    sp.acot: lambda x: sp.atan(1 / x),
    sp.asec: lambda x: sp.acos(1 / x),
    sp.acsc: lambda x: sp.asin(1 / x),
    sp.acoth: lambda x: sp.atanh(1 / x),
    sp.asech: lambda x: sp.acosh(1 / x),
    sp.acsch: lambda x: sp.asinh(1 / x),
}


def on_the_real_line(expression: sp.Expr) -> sp.Expr:
    """SymPy's complex functions replaced by the real ones above, and ratios by ratios."""
    if sp.Piecewise in _kinds(expression):
        expression = expression.replace(sp.Piecewise, _pieces)
    kinds = _kinds(expression)
    for complex_one, real_one in _REAL.items():
        if complex_one in kinds:
            expression = expression.replace(complex_one, real_one)
    if angle in kinds or sp.atan2 in kinds:
        for wave in (sp.sin, sp.cos, sp.tan):
            expression = expression.replace(wave, lambda x, wave=wave: wave(_turning(x)))
    return expression


def _kinds(expression: sp.Expr) -> set:
    return {part.func for part in sp.preorder_traversal(expression)}


def _turning(argument: sp.Expr) -> sp.Expr:
    """The argument of a wave, with whole multiples of an angle as those of a ``turn``."""
    terms = []
    for term in sp.Add.make_args(argument):
        times, rest = term.as_coeff_Mul()
        terms.append(times * turn(*rest.args) if times.is_Integer and rest.func is angle else term)
    return sp.Add(*terms)


def _pieces(*pieces) -> sp.Expr:
    """Piecewise((a, a condition), ..., (z, True)) as choices; as it is where that is not said."""
    if pieces[-1][1] is not sp.true:
        return sp.Piecewise(*pieces, evaluate=False)
    result = pieces[-1][0]
    for value, condition in reversed(pieces[:-1]):
        result = chosen(_excess(condition), value, result)
    return result


def _excess(condition: sp.Basic) -> sp.Expr:
    """A number that is positive where a condition holds and negative where it does not."""
    if isinstance(condition, (sp.Gt, sp.Ge)):
        return condition.lhs - condition.rhs
    if isinstance(condition, (sp.Lt, sp.Le)):
        return condition.rhs - condition.lhs
    if isinstance(condition, sp.And):
        return folded(minimum, [_excess(part) for part in condition.args])
    if isinstance(condition, sp.Or):
        return folded(maximum, [_excess(part) for part in condition.args])
    if isinstance(condition, sp.Not):
        return -_excess(condition.args[0])
    return sp.Integer(1 if condition is sp.true else -1)


def folded(pair: Callable[[Any, Any], Any], arguments: Sequence[Any]) -> Any:
    """A function of two applied to many, from the left."""
    result = arguments[0]
    for argument in arguments[1:]:
        result = pair(result, argument)
    return result
