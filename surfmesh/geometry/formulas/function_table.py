"""The functions and constants that may stand in a formula, by name."""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable
from typing import NamedTuple

import sympy as sp

from surfmesh.geometry.formulas import real_functions as real


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


def known_functions(name: str) -> str:
    """What may have been meant by an unknown name, and all functions, in one line."""
    own = [known for known in FUNCTIONS if known not in OTHER_NAMES]
    close = difflib.get_close_matches(name.lower(), [known.lower() for known in FUNCTIONS], 3)
    near = [known for known in FUNCTIONS if known.lower() in close and known not in OTHER_NAMES]
    meant = f"; did you mean {' or '.join(near)}?" if near else ""
    return f"{meant}; the functions are {', '.join(own)}"
