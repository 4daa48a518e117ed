"""Gauss's rule on an interval, correctly rounded: the same on every processor."""

from __future__ import annotations

from decimal import Decimal, localcontext
from functools import cache

import numpy as np

DIGITS, STEPS = 34, 6
"""Of the arithmetic that nodes are polished in; Newton's steps: two are enough."""


@cache
def unit_rule(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of Gauss's rule from -1 to 1."""
    nodes, weights = np.empty((2, points))
    with localcontext() as context:
        context.prec = DIGITS
        for k, guess in enumerate(np.polynomial.legendre.leggauss(points)[0].tolist()):
            x = Decimal(guess)
            for _ in range(STEPS):
                value, slope = _legendre(points, x)
                x -= value / slope
            slope = _legendre(points, x)[1]
            nodes[k], weights[k] = float(x), float(2 / ((1 - x * x) * slope * slope))
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights


def _legendre(degree: int, x: Decimal) -> tuple[Decimal, Decimal]:
    """Legendre's polynomial and its derivative."""
    before, value = Decimal(0), Decimal(1)
    for k in range(degree):
        before, value = value, ((2 * k + 1) * x * value - k * before) / (k + 1)
    return value, degree * (x * value - before) / (x * x - 1)


def gauss_rule(first: float, last: float, cells: int, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of the rule with so many points in each of ``cells`` equal parts."""
    nodes, weights = unit_rule(points)
    width = (last - first) / cells
    starts = first + width * np.arange(cells)
    places = (starts[:, None] + 0.5 * width * (nodes + 1.0)).ravel()
    return places, np.tile(0.5 * width * weights, cells)
