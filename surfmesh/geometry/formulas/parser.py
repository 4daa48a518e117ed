"""Formulas as text: recursive descent, through a whitelist.

    sum      = product {("+" | "-") product}
    product  = signed {("*" | "/") signed}
    signed   = ("+" | "-") signed | power
    power    = atom [("**" | "^") signed]
    atom     = number | name | function "(" sum {"," sum} ")" | "(" sum ")"

Every constant part is worked out in floats first, so that no number beyond what a float
holds ever reaches SymPy's exact arithmetic.
"""

from __future__ import annotations

import math
import numbers
import re
import unicodedata
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import reduce
from typing import NamedTuple, NoReturn, TypeGuard

import sympy as sp

from surfmesh.errors import FormulaError, SurfaceError, shown
from surfmesh.geometry.formulas import real_functions as real
from surfmesh.geometry.formulas.compilation import compiled
from surfmesh.geometry.formulas.function_table import CONSTANTS, FUNCTIONS, known_functions
from surfmesh.geometry.number_range import RANGE

LONGEST = 10_000  # characters of a formula
LONGEST_NAME = 20  # characters of one that a message shows
DEEPEST = 64  # levels of parentheses, calls, signs and powers
LARGEST_EXPONENT = 64  # of a power with a constant exponent
MOST_DIGITS, ALL_DIGITS = 20_000, 200_000  # binary digits of one exact power, of all together


_TOKEN = re.compile(
    r"(?P<space>[ \t\r\n]+)"
    r"|(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<operator>\*\*|[-+*/^(),])"
)
_REASONS = {
    ".": "attribute access is not part of a formula",
    "=": "assignment and comparison are not part of a formula",
    "<": "comparison is not part of a formula",
    ">": "comparison is not part of a formula",
    "!": "comparison and factorial are not part of a formula",
    '"': "text in quotes is not part of a formula",
    "'": "text in quotes is not part of a formula",
    "[": "brackets [ ] are not part of a formula; group with ( )",
    "{": "braces { } are not part of a formula; group with ( )",
}


def symbol(name: str) -> sp.Symbol:
    """The symbol that stands for a variable in every parsed expression."""
    return sp.Symbol(name, real=True)


class _Part(NamedTuple):
    """A parsed piece: what it is, its value when it is constant, and where it starts."""

    expression: sp.Expr
    value: float | None
    column: int


class Parser:
    def __init__(self, text: str, names: Sequence[str], parameters: Mapping[str, float]) -> None:
        self.text = text
        self.variables = {name: symbol(name) for name in names}
        self.parameters = parameters
        if len(text) > LONGEST:
            self._refuse(f"longer than {LONGEST} characters", LONGEST + 1)
        self.tokens = list(self._tokens())
        self.place = 0
        self.depth = 0
        self.digits = 0.0  # binary ones, of exact powers

    def formula(self) -> _Part:
        if not self.tokens:
            self._refuse("the formula is empty", 1)
        result = self._sum()
        token = self._next()
        if token is not None:
            _, found, column = token
            if found == ")":
                self._refuse("this parenthesis was never opened", column)
            if found == ",":
                self._refuse("a comma outside a function's parentheses", column)
            self._refuse(f"an operator is missing before {quoted(found)}", column)
        if result.expression.has(sp.I, sp.zoo, sp.nan, sp.oo):
            self._refuse("the formula is not a finite real number", 1)
        # SymPy turns sqrt(u**2) into its own Abs(u)
        return result._replace(expression=real.on_the_real_line(result.expression))

    def _sum(self) -> _Part:
        parts = [self._product()]
        while (sign := self._take("+", "-")) is not None:
            part = self._product()
            parts.append(part if sign == "+" else _negative(part))
        return self._joined(parts, sp.Add, lambda a, b: a + b)

    def _product(self) -> _Part:
        parts = [self._signed()]
        while (sign := self._take("*", "/")) is not None:
            part = self._signed()
            if sign == "/":
                if part.expression.is_zero or part.value == 0.0:
                    self._refuse("division by zero", part.column)
                value = None if part.value is None else 1.0 / part.value
                part = _Part(1 / part.expression, value, part.column)
            parts.append(part)
        return self._joined(parts, sp.Mul, lambda a, b: a * b)

    def _signed(self) -> _Part:
        column = self._column()
        sign = self._take("+", "-")
        if sign is None:
            return self._power()
        self._enter(column)
        part = self._signed()
        self.depth -= 1
        return part if sign == "+" else _negative(part)._replace(column=column)

    def _power(self) -> _Part:
        base = self._atom()
        column = self._column()
        if self._take("**", "^") is None:
            return base
        self._enter(column)
        exponent = self._signed()
        self.depth -= 1
        if exponent.value is not None and abs(exponent.value) > LARGEST_EXPONENT:
            self._refuse(f"an exponent beyond {LARGEST_EXPONENT}", exponent.column)
        coefficient = base.expression.as_coeff_Mul()[0]
        if exponent.value is not None:
            digits = digits_of(coefficient) * abs(exponent.value)
            self.digits += digits
            if digits > MOST_DIGITS or self.digits > ALL_DIGITS:
                self._refuse("a power with too many digits", exponent.column)
        if base.value is not None and exponent.value is not None:
            self._value(math.pow, (base.value, exponent.value), base.column)
        result = self._joined([base, exponent], sp.Pow, lambda a, b: a**b)
        factors = sp.Mul.make_args(result.expression)
        exponents = [factor.exp for factor in factors if factor.is_Pow and factor.exp.is_Rational]
        if any(abs(exponent) > LARGEST_EXPONENT for exponent in exponents):
            self._refuse(f"an exponent beyond {LARGEST_EXPONENT}", column)  # (u**9)**9
        if sp.I in factors:
            self._refuse("the power is not a real number", base.column)
        return result

    def _atom(self) -> _Part:
        token = self._next()
        if token is None:
            self._refuse("the formula ends where a value is expected", len(self.text.rstrip()) + 1)
        kind, found, column = token
        if kind == "number":
            return self._literal(found, column)
        if kind == "name":
            return self._named(found, column)
        if found == "(":
            self._enter(column)
            inner = self._sum()
            self._close(column)
            return inner
        self._refuse(f"a value is expected, not {quoted(found)}", column)

    def _literal(self, digits: str, column: int) -> _Part:
        value = float(digits)
        if value > RANGE.constant:
            self._refuse("the number is too large", column)
        short = len(digits) <= 30 and (value == 0.0 or 1e-30 < value < 1e30)
        # decimals stay exact: u**0.5 is a square root, and derivatives have clean coefficients
        return _Part(sp.Rational(digits if short else value), value, column)

    def _named(self, name: str, column: int) -> _Part:
        called = self.place < len(self.tokens) and self.tokens[self.place][1] == "("
        if name in FUNCTIONS:
            if not called:
                self._refuse(f"{name} is a function: write {name}(...)", column)
            return self._call(name, column)
        if called:
            short = cut_short(name)
            if name in self.variables or name in self.parameters or name in CONSTANTS:
                self._refuse(f"{short} is not a function", column)
            self._refuse(f"{short} is not a known function{known_functions(name)}", column)
        if name in self.variables:
            return _Part(self.variables[name], None, column)
        if name in self.parameters:
            expression = rational(self.parameters[name])
            return _Part(expression, float(expression), column)
        if name in CONSTANTS:
            return _Part(CONSTANTS[name], float(CONSTANTS[name]), column)
        known = ", ".join([*self.variables, *self.parameters, *CONSTANTS])
        self._refuse(
            f"unknown name {quoted(name)}; known are {known} and functions{known_functions(name)}",
            column,
        )

    def _call(self, name: str, column: int) -> _Part:
        function = FUNCTIONS[name]
        opening = self._column()
        self._next()
        self._enter(opening)
        arguments = []
        if not (self.place < len(self.tokens) and self.tokens[self.place][1] == ")"):
            arguments.append(self._sum())
            while self._take(",") is not None:
                arguments.append(self._sum())
        self._close(opening)
        if not function.fewest <= len(arguments) <= function.most:
            wanted = str(function.fewest)
            if function.most > function.fewest:
                wanted = f"{function.fewest} to {function.most}"
            plural = "" if wanted == "1" else "s"
            self._refuse(f"{name} takes {wanted} argument{plural}, not {len(arguments)}", column)
        known = [a.value for a in arguments if a.value is not None]
        value = self._value(function.value, known, column) if len(known) == len(arguments) else None
        expression = function.build(*(argument.expression for argument in arguments))
        if sp.I in expression.args or (expression.is_Atom and expression.is_finite is False):
            self._refuse(f"{name} is not a finite real number here", column)
        return _Part(expression, value, column)

    def _joined(self, parts: list[_Part], build: Callable, operation: Callable) -> _Part:
        """Parts put together at once; constants are first worked out as floats, left to right."""
        if len(parts) == 1:
            return parts[0]
        column = parts[0].column
        known = [part.value for part in parts if part.value is not None]
        value = None
        if len(known) == len(parts):
            value = reduce(lambda a, b: self._value(operation, (a, b), column), known)
        expression = build(*(part.expression for part in parts))
        if expression.is_Atom and expression.is_finite is False:  # sin(pi)**-1, exactly
            self._refuse("not a finite real number", column)
        if value is None and expression.is_number:  # u - u
            value = number_of(expression, self.text, column)
        return _Part(expression, value, column)

    def _value(self, function: Callable, arguments: Sequence[float], column: int) -> float:
        try:
            value = function(*arguments)
        except (ValueError, ZeroDivisionError):
            self._refuse("not a finite real number", column)
        except OverflowError:
            self._refuse("the number is too large", column)
        if isinstance(value, complex) or math.isnan(value):
            self._refuse("not a finite real number", column)
        if abs(value) > RANGE.constant:
            self._refuse("the number is too large", column)
        return float(value)

    def _tokens(self) -> Iterator[tuple[str, str, int]]:
        position = 0
        while position < len(self.text):
            match = _TOKEN.match(self.text, position)
            if match is None:
                self._refuse(_stray(self.text[position]), position + 1)
            if match.lastgroup is not None and match.lastgroup != "space":
                yield match.lastgroup, match.group(), position + 1
            position = match.end()

    def _next(self) -> tuple[str, str, int] | None:
        if self.place == len(self.tokens):
            return None
        self.place += 1
        return self.tokens[self.place - 1]

    def _take(self, *operators: str) -> str | None:
        """The next token if it is one of these operators."""
        if self.place < len(self.tokens) and self.tokens[self.place][1] in operators:
            self.place += 1
            return self.tokens[self.place - 1][1]
        return None

    def _column(self) -> int:
        if self.place < len(self.tokens):
            return self.tokens[self.place][2]
        return len(self.text) + 1

    def _enter(self, column: int) -> None:
        self.depth += 1
        if self.depth > DEEPEST:
            self._refuse(f"nested deeper than {DEEPEST} levels", column)

    def _close(self, opening: int) -> None:
        self.depth -= 1
        column = self._column()
        if self._take(")") is not None:
            return
        token = self._next()
        if token is None:
            self._refuse("this parenthesis is never closed", opening)
        if token[1] == ",":
            self._refuse("a comma outside a function's parentheses", column)
        self._refuse(f"an operator is missing before {quoted(token[1])}", column)

    def _refuse(self, reason: str, column: int) -> NoReturn:
        raise FormulaError(reason, self.text, column)


def _negative(part: _Part) -> _Part:
    return part._replace(
        expression=-part.expression, value=None if part.value is None else -part.value
    )


def as_text(text: object) -> str:
    if isinstance(text, str):
        # a line break would tear the caret from its column
        return re.sub(r"[\r\n\t]", " ", text)
    if is_number(text):
        number = finite(text)
        return repr(int(text)) if isinstance(text, numbers.Integral) else repr(number)
    raise FormulaError(f"a formula is text, a number or a SymPy expression, not {shown(text)}")


def is_number(value: object) -> TypeGuard[numbers.Real]:
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def is_finite(value: numbers.Real) -> bool:
    """Is a real number of any type a number as a float too?"""
    try:
        return math.isfinite(float(value))
    except (OverflowError, ValueError):  # an integer beyond all floats
        return False


def finite(value: numbers.Real) -> float:
    if not is_finite(value):
        raise FormulaError("a finite number is needed", shown(value))
    return float(value)


def _stray(character: str) -> str:
    if character.isascii():
        if character in _REASONS:
            return f"{quoted(character)}: {_REASONS[character]}"
        return f"{character!r} is not part of a formula"
    name = unicodedata.name(character, "unnamed")
    seen = quoted(character) if character.isprintable() else "this"
    return f"{seen} (U+{ord(character):04X}, {name.lower()}) is not a plain character"


def quoted(token: str) -> str:
    return f"'{cut_short(token)}'"


def cut_short(token: str) -> str:
    return token if len(token) <= LONGEST_NAME else f"{token[:LONGEST_NAME]}..."


def rational(number: object) -> sp.Rational:
    """The shortest decimal that a number prints as, exactly."""
    if not is_number(number) or not abs(finite(number)) <= RANGE.constant:
        raise SurfaceError(f"a parameter must be a finite number, not {shown(number)}")
    return sp.Rational(repr(float(number)))


def digits_of(number: sp.Expr) -> int:
    """Binary digits of a fraction, numerator and denominator together."""
    return int(number.p).bit_length() + int(number.q).bit_length() if number.is_Rational else 0


def number_of(expression: sp.Expr, text: str, column: int) -> float:
    """The value of an expression without variables, worked out in floats."""
    if not expression.has(sp.I, sp.zoo, sp.nan, sp.oo):
        tape = compiled([expression], ())
        value = tape.constants[0] if tape.constants else math.nan
        if abs(value) <= RANGE.constant:
            return value
    raise FormulaError("not a finite real number", text, column)
