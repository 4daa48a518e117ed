"""Formulas as data: text to SymPy expressions through a whitelist, nothing executed as Python.

    sum      = product {("+" | "-") product}
    product  = signed {("*" | "/") signed}
    signed   = ("+" | "-") signed | power
    power    = atom [("**" | "^") signed]
    atom     = number | name | function "(" sum {"," sum} ")" | "(" sum ")"

Every constant part is worked out in floats first, so that no number beyond what a float
holds ever reaches SymPy's exact arithmetic.
"""

from __future__ import annotations

import difflib
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
from surfmesh.geometry.formulas.program import FUNCTION_OPERATIONS
from surfmesh.geometry.number_range import RANGE

LONGEST = 10_000  # characters of a formula
LONGEST_NAME = 20  # characters of one that a message shows
DEEPEST = 64  # levels of parentheses, calls, signs and powers
DEEPEST_READY = 150  # levels of a ready-made expression, each of its operations being one
READY_DIGITS = 10_000  # binary digits of a number in it
LARGEST_EXPONENT = 64  # of a power with a constant exponent
MOST_DIGITS, ALL_DIGITS = 20_000, 200_000  # binary digits of one exact power, of all together
MOST_OPERATIONS = 8_000  # of a ready-made expression, whose text may be endless


class Function(NamedTuple):
    """A function that may stand in a formula."""

    build: Callable  # SymPy arguments to a SymPy expression
    value: Callable  # float arguments to a float; raises where it is undefined
    fewest: int = 1
    most: int = 1


FUNCTIONS: dict[str, Function] = {
    "sin": Function(sp.sin, math.sin),
    "cos": Function(sp.cos, math.cos),
    "tan": Function(sp.tan, math.tan),
    "asin": Function(sp.asin, math.asin),
    "acos": Function(sp.acos, math.acos),
    "atan": Function(sp.atan, math.atan),
    "atan2": Function(real.angle, math.atan2, 2, 2),
    "sinh": Function(sp.sinh, math.sinh),
    "cosh": Function(sp.cosh, math.cosh),
    "tanh": Function(sp.tanh, math.tanh),
    "asinh": Function(sp.asinh, math.asinh),
    "acosh": Function(sp.acosh, math.acosh),
    "atanh": Function(sp.atanh, math.atanh),
    "sec": Function(lambda x: 1 / sp.cos(x), lambda x: 1 / math.cos(x)),
    "csc": Function(lambda x: 1 / sp.sin(x), lambda x: 1 / math.sin(x)),
    "cot": Function(lambda x: sp.cos(x) / sp.sin(x), lambda x: math.cos(x) / math.sin(x)),
    "asec": Function(lambda x: sp.acos(1 / x), lambda x: math.acos(1 / x)),
    "acsc": Function(lambda x: sp.asin(1 / x), lambda x: math.asin(1 / x)),
    "acot": Function(lambda x: sp.atan(1 / x), lambda x: math.atan(1 / x)),
    "sech": Function(lambda x: 1 / sp.cosh(x), lambda x: 1 / math.cosh(x)),
    "csch": Function(lambda x: 1 / sp.sinh(x), lambda x: 1 / math.sinh(x)),
    "coth": Function(lambda x: 1 / sp.tanh(x), lambda x: 1 / math.tanh(x)),
    "asech": Function(lambda x: sp.acosh(1 / x), lambda x: math.acosh(1 / x)),
    "acsch": Function(lambda x: sp.asinh(1 / x), lambda x: math.asinh(1 / x)),
    "acoth": Function(lambda x: sp.atanh(1 / x), lambda x: math.atanh(1 / x)),
    "exp": Function(sp.exp, math.exp),
    "log": Function(sp.log, math.log),
    "log2": Function(lambda x: sp.log(x) / sp.log(2), math.log2),
    "log10": Function(lambda x: sp.log(x) / sp.log(10), math.log10),
    "sqrt": Function(sp.sqrt, math.sqrt),
    "cbrt": Function(real.cube_root, math.cbrt),
    "hypot": Function(lambda x, y: sp.sqrt(x**2 + y**2), math.hypot, 2, 2),
    "erf": Function(sp.erf, math.erf),
    "erfc": Function(lambda x: 1 - sp.erf(x), math.erfc),
    "sinc": Function(real.sinc, lambda x: math.sin(x) / x if x else 1.0),
    "abs": Function(real.absolute, abs),
    "sign": Function(real.signum, lambda x: (x > 0) - (x < 0)),
    "heaviside": Function(real.unit_step, lambda x: 0.5 * (1 + (x > 0) - (x < 0))),
    "floor": Function(real.integer_part, math.floor),
    "ceiling": Function(lambda x: -real.integer_part(-x), math.ceil),
    "min": Function(lambda *xs: real.folded(real.minimum, xs), min, 2, 16),
    "max": Function(lambda *xs: real.folded(real.maximum, xs), max, 2, 16),
}
OTHER_NAMES = {
    **{"ln": "log", "Abs": "abs", "fabs": "abs", "Min": "min", "Max": "max"},
    **{"Heaviside": "heaviside", "ceil": "ceiling"},
    **{"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2"},
    **{"arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh"},
}  # what SymPy, numpy and C call them
FUNCTIONS |= {other: FUNCTIONS[name] for other, name in OTHER_NAMES.items()}
CONSTANTS: dict[str, sp.Expr] = {"pi": sp.pi, "e": sp.E, "tau": 2 * sp.pi}
RESERVED = FUNCTIONS.keys() | CONSTANTS.keys()  # names that no variable or parameter may take

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
    return _Parser(_as_text(text), names, parameters or {}).formula().expression


def parse_number(text: str | float | sp.Expr) -> float:
    """A finite number from text such as "2*pi", from a number or a constant expression.

    Raises FormulaError.
    """
    if isinstance(text, sp.Basic):
        expression = _checked(text, (), {})
        return _number(expression, str(expression), 1)
    if _is_number(text):
        return _finite(text)
    part = _Parser(_as_text(text), (), {}).formula()
    return _number(part.expression, _as_text(text), 1) if part.value is None else part.value


def symbol(name: str) -> sp.Symbol:
    """The symbol that stands for a variable in every parsed expression."""
    return sp.Symbol(name, real=True)


class _Part(NamedTuple):
    """A parsed piece: what it is, its value when it is constant, and where it starts."""

    expression: sp.Expr
    value: float | None
    column: int


class _Parser:
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
            self._refuse(f"an operator is missing before {_shown(found)}", column)
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
            digits = _digits(coefficient) * abs(exponent.value)
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
        self._refuse(f"a value is expected, not {_shown(found)}", column)

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
            short = _cut(name)
            if name in self.variables or name in self.parameters or name in CONSTANTS:
                self._refuse(f"{short} is not a function", column)
            self._refuse(f"{short} is not a known function{_known_functions(name)}", column)
        if name in self.variables:
            return _Part(self.variables[name], None, column)
        if name in self.parameters:
            expression = _rational(self.parameters[name])
            return _Part(expression, float(expression), column)
        if name in CONSTANTS:
            return _Part(CONSTANTS[name], float(CONSTANTS[name]), column)
        known = ", ".join([*self.variables, *self.parameters, *CONSTANTS])
        self._refuse(
            f"unknown name {_shown(name)}; known are {known} and functions{_known_functions(name)}",
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
            value = _number(expression, self.text, column)
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
        self._refuse(f"an operator is missing before {_shown(token[1])}", column)

    def _refuse(self, reason: str, column: int) -> NoReturn:
        raise FormulaError(reason, self.text, column)


def _known_functions(name: str) -> str:
    """What may have been meant by an unknown name, and all functions, in one line."""
    own = [known for known in FUNCTIONS if known not in OTHER_NAMES]
    close = difflib.get_close_matches(name.lower(), [known.lower() for known in FUNCTIONS], 3)
    near = [known for known in FUNCTIONS if known.lower() in close and known not in OTHER_NAMES]
    meant = f"; did you mean {' or '.join(near)}?" if near else ""
    return f"{meant}; the functions are {', '.join(own)}"


def _negative(part: _Part) -> _Part:
    return part._replace(
        expression=-part.expression, value=None if part.value is None else -part.value
    )


def _as_text(text: object) -> str:
    if isinstance(text, str):
        # a line break would tear the caret from its column
        return re.sub(r"[\r\n\t]", " ", text)
    if _is_number(text):
        number = _finite(text)
        return repr(int(text)) if isinstance(text, numbers.Integral) else repr(number)
    raise FormulaError(f"a formula is text, a number or a SymPy expression, not {shown(text)}")


def _is_number(value: object) -> TypeGuard[numbers.Real]:
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def is_finite(value: numbers.Real) -> bool:
    """Is a real number of any type a number as a float too?"""
    try:
        return math.isfinite(float(value))
    except (OverflowError, ValueError):  # an integer beyond all floats
        return False


def _finite(value: numbers.Real) -> float:
    if not is_finite(value):
        raise FormulaError("a finite number is needed", shown(value))
    return float(value)


def _stray(character: str) -> str:
    if character.isascii():
        if character in _REASONS:
            return f"{_shown(character)}: {_REASONS[character]}"
        return f"{character!r} is not part of a formula"
    name = unicodedata.name(character, "unnamed")
    seen = _shown(character) if character.isprintable() else "this"
    return f"{seen} (U+{ord(character):04X}, {name.lower()}) is not a plain character"


def _shown(token: str) -> str:
    return f"'{_cut(token)}'"


def _cut(token: str) -> str:
    return token if len(token) <= LONGEST_NAME else f"{token[:LONGEST_NAME]}..."


def _rational(number: object) -> sp.Rational:
    """The shortest decimal that a number prints as, exactly."""
    if not _is_number(number) or not abs(_finite(number)) <= RANGE.constant:
        raise SurfaceError(f"a parameter must be a finite number, not {shown(number)}")
    return sp.Rational(repr(float(number)))


def _digits(number: sp.Expr) -> int:
    """Binary digits of a fraction, numerator and denominator together."""
    return int(number.p).bit_length() + int(number.q).bit_length() if number.is_Rational else 0


def _number(expression: sp.Expr, text: str, column: int) -> float:
    """The value of an expression without variables, worked out in floats."""
    if not expression.has(sp.I, sp.zoo, sp.nan, sp.oo):
        tape = compiled([expression], ())
        value = tape.constants[0] if tape.constants else math.nan
        if abs(value) <= RANGE.constant:
            return value
    raise FormulaError("not a finite real number", text, column)


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
            known[free] = _rational(parameters[free.name])
        else:
            raise FormulaError(f"unknown name {_shown(free.name)}", text)
    for number in expression.atoms(sp.Float):
        if number.is_finite:
            known[number] = sp.Rational(repr(float(number)))
    expression = real.on_the_real_line(expression.xreplace(known))
    for part in sp.preorder_traversal(expression):
        allowed = part.is_Add or part.is_Mul or part.is_Pow or part.is_Symbol
        allowed |= part.is_Rational or part.is_NumberSymbol
        if not (allowed or part.func in FUNCTION_OPERATIONS):
            raise FormulaError(
                f"{_shown(str(part))} is not part of a formula{_known_functions(str(part.func))}",
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
        many = part.is_Rational and _digits(part) > READY_DIGITS
        if many or (part.is_Number and part.is_finite and abs(part) > RANGE.constant):
            raise FormulaError("a number in the expression is too large, or has too many digits")
        sizes[part] = operations, levels


_CURE = ": give the surface as a function, a NumericSurface"
