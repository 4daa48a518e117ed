"""Random smooth surfaces by a grammar of formulas: pure functions of (seed, number)."""

from __future__ import annotations

import math
from random import Random

import numpy as np

from judge.surfaces import Truth

TURN = (0.0, 2 * math.pi)


def surface_of(seed: int, number: int) -> tuple[str, Truth]:
    """The kind of the surface of this number, and its truth."""
    draw = Random(f"surface {seed} {number}")
    kind = draw.choice(tuple(_MAKERS))
    truth = _MAKERS[kind](draw)
    scale = draw.choice((1.0, 1.0, 1.0, 1e-9, 1e9, 1e-25, 1e24))
    if scale != 1.0:
        formulas = tuple(f"{scale!r}*({text})" for text in truth.formulas)
        truth = Truth(**{**truth.__dict__, "formulas": formulas})
    return kind, truth


def _number(draw: Random, low: float, high: float) -> str:
    return repr(round(draw.uniform(low, high), 3))


def _waves(draw: Random, variables: str, height: float, fastest: float = 4.0) -> str:
    """A sum of one to three smooth terms of the variables, each at most about so high."""
    terms = []
    for _ in range(draw.randint(1, 3)):
        a, w, p = _number(draw, -height, height), _number(draw, 0.5, fastest), _number(draw, 0, 6)
        x = draw.choice(variables)
        y = draw.choice(variables)
        terms.append(draw.choice((
            f"{a}*sin({w}*{x} + {p})",
            f"{a}*cos({w}*{x})*sin({x} + {p})",
            f"{a}*cos({w}*{x} + {y})",
            f"{a}*exp(-({x} - 0.3)**2 - {w}*({y} + 0.2)**2)",
            f"{a}*{x}*{y}",
            f"{a}*{x}**2/(1 + {y}**2)",
            f"{a}*tanh({w}*({x} - 0.1))",
        )))  # fmt: skip
    return " + ".join(terms)


def _harmonics(draw: Random, variable: str, fraction: float) -> str:
    """1 + a Fourier polynomial of the variable that is at most ``share``."""
    terms, left = ["1"], fraction
    for _ in range(draw.randint(1, 3)):
        a = round(draw.uniform(0, left), 3)
        left -= a
        wave = draw.choice(("cos", "sin"))
        terms.append(f"{draw.choice(('', '-'))}{a}*{wave}({draw.randint(1, 5)}*{variable})")
    return "(" + " + ".join(terms) + ")"


def _graph(draw: Random) -> Truth:
    wide = draw.uniform(0.5, 3)
    return Truth(("u", "v", _waves(draw, "uv", 0.6)), (-wide, wide), (-1.0, draw.uniform(0.2, 2)))


def _trimmed(draw: Random) -> Truth:
    plain = _graph(draw)
    (u0, u1), (v0, v1) = plain.u, plain.v
    middle, half = ((u0 + u1) / 2, (v0 + v1) / 2), ((u1 - u0) / 2, (v1 - v0) / 2)

    def ring(count: int, x: float, y: float, fraction: float) -> np.ndarray:
        a = 2 * math.pi * (np.arange(count) + draw.random()) / count
        u = middle[0] + half[0] * (x + fraction * np.cos(a))
        return np.column_stack([u, middle[1] + half[1] * (y + fraction * np.sin(a))])

    loops = [ring(draw.choice((5, 24, 100)), 0, 0, draw.uniform(0.6, 0.98))]
    for x in (-0.3, 0.3)[: draw.randint(0, 2)]:
        loops.append(ring(draw.choice((3, 8, 40)), x, 0, draw.uniform(0.05, 0.2)))
    holes = len(loops) - 1
    return Truth(plain.formulas, plain.u, plain.v, tuple(loops), 1 - holes, 1 + holes)


def _revolved(draw: Random) -> Truth:
    profile = f"{_number(draw, 0.3, 2)}*{_harmonics(draw, 'v', 0.7)}"
    whole = draw.random() < 0.7
    u = TURN if whole else (0.0, draw.uniform(1, 5.5))
    formulas = f"{profile}*cos(u)", f"{profile}*sin(u)", "v"
    v = (0.0, draw.uniform(0.5, 5))
    return Truth(formulas, u, v, euler=0 if whole else 1, borders=2 if whole else 1)


def _ball(draw: Random) -> Truth:
    m, a = draw.randint(1, 5), _number(draw, 0, 0.35)
    radius = f"(1 + {a}*sin(v)**{m}*cos({m}*u) + {_number(draw, -0.3, 0.3)}*cos(v)**2)"
    x, y, z = (_number(draw, 0.3, 2) for _ in range(3))
    places = (x, "sin(v)*cos(u)"), (y, "sin(v)*sin(u)"), (z, "cos(v)")
    formulas = tuple(f"{size}*{radius}*{place}" for size, place in places)
    if draw.random() < 0.7:
        return Truth(formulas, TURN, (0.0, math.pi), euler=2, borders=0)
    return Truth(formulas, TURN, (draw.uniform(0.3, 2), math.pi), euler=1, borders=1)


def _torus(draw: Random) -> Truth:
    thin = _number(draw, 0.1, 0.45)
    tube = f"{thin}*{_harmonics(draw, 'u', 0.4)}*{_harmonics(draw, 'v', 0.3)}"
    around = f"({_harmonics(draw, 'u', 0.1)} + {tube}*cos(v))"
    formulas = f"{around}*cos(u)", f"{around}*sin(u)", f"{tube}*sin(v)"
    return Truth(formulas, TURN, TURN, euler=0, borders=0, embedded=float(thin) < 0.4)


def _tube(draw: Random) -> Truth:
    x, y = _waves(draw, "u", 0.8, 2.5), _waves(draw, "u", 0.8, 2.5)
    radius = f"{_number(draw, 0.05, 0.6)}*{_harmonics(draw, 'u', 0.5)}"
    formulas = f"{x} + {radius}*cos(v)", f"{y} + {radius}*sin(v)", f"{_number(draw, 0.5, 2)}*u"
    return Truth(formulas, (0.0, draw.uniform(1, 4)), TURN, euler=0, borders=2)


def _ruled(draw: Random) -> Truth:
    low, high, wide = _waves(draw, "u", 0.5), _waves(draw, "u", 0.5), _number(draw, 0.3, 2)
    formulas = "u", f"{wide}*v", f"(1 - v)*({low}) + v*({high})"
    return Truth(formulas, (-1.0, draw.uniform(0, 3)), (0.0, 1.0))


def _disc(draw: Random) -> Truth:
    height = draw.choice((
        f"{_number(draw, -1, 1)}*u**2", f"{_number(draw, 0.2, 2)}*u",
        f"{_number(draw, -0.5, 0.5)}*cos({_number(draw, 1, 4)}*u)",
    ))  # fmt: skip
    ripple = f"{_number(draw, 0, 0.3)}*u**2*cos(2*v)"
    formulas = f"{_number(draw, 0.4, 2)}*u*cos(v)", "u*sin(v)", f"{height} + {ripple}"
    return Truth(formulas, (0.0, draw.uniform(0.5, 3)), TURN)


def _strip(draw: Random) -> Truth:
    """A Moebius strip, with waves."""
    around = f"({_harmonics(draw, 'u', 0.1)} + v*cos(u/2))"
    formulas = f"{around}*cos(u)", f"{around}*sin(u)", "v*sin(u/2)"
    half = draw.uniform(0.05, 0.4)
    return Truth(formulas, TURN, (-half, half), euler=0, borders=1, oriented=False)


_MAKERS = {
    "graph": _graph, "trimmed graph": _trimmed, "revolved": _revolved, "ball": _ball,
    "torus": _torus, "tube": _tube, "ruled": _ruled, "disc": _disc, "strip": _strip,
}  # fmt: skip
