"""Sizes at the sides of a gap that put a number of triangles across it."""

import math

ROW = 0.5 * math.sqrt(3.0)
"""Height of a row of unit triangles."""

LARGEST = 700.0
"""Of an exponent whose power is a number."""


def size_across(gap: float, count: float, slope: float) -> float:
    """Edge length at both sides of a gap that has at least ``count`` triangles across.

    With the size h at the sides growing by ``slope`` towards the middle, the rows that fit are
    the integral of 1 / (ROW size):  2 / (ROW slope) ln(1 + slope gap / (2 h)) = count.
    """
    growth = min(0.5 * ROW * count * slope, LARGEST)
    grown = slope * gap / (2.0 * math.expm1(growth))
    return min(grown, gap / count)
