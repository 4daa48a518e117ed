"""The coarsest setting of a mesher whose mesh keeps to a limit: a bisection that looks ahead.

A setting is a fineness x: the deviation falls about as x^-2, the triangles grow as x^2. What is
looked for is the smallest x that keeps the limit. Until it is bracketed the law places the next
attempt; then a line through the bracket's ends in log x, log deviation; every third attempt
halves the bracket, so that it shrinks whatever the mesher does.
"""

import math
from collections.abc import Sequence

import numpy as np

ALLOWED = 0.001  # share of the triangles that may lie farther away
NEAR = 1.02  # ratio of the bracket's ends: 4 % of the triangles are not worth another attempt
AIM = 0.98  # of the limit: an attempt that should keep it
MISS = 1.02  # of the limit: one that should not, when the bracket's other end is close to it
LARGEST_STEP = 4.0  # factor on x, while there is no bracket
SMALLEST_STEP = 1.05  # likewise; its square after two attempts, and so on
LEAST = 1e-3  # of the limit: what lies nearer says nothing more
INSET = 0.1  # share of the bracket, in log x, that an attempt takes off it at least
HALVED = 3  # every so many attempts


def reach(deviation: np.ndarray) -> float:
    """The distance within which all but one in a thousand of the triangles lie."""
    beyond = math.floor(ALLOWED * len(deviation))
    return float(np.sort(deviation)[len(deviation) - 1 - beyond])


def next_fineness(
    tried: Sequence[tuple[float, float]], lowest: float, highest: float
) -> float | None:
    """Where to look next, within [lowest, highest]; None when there is nothing left to gain.

    tried: (x, reach / limit) in the order of the attempts, one at least. Of attempts that
    contradict each other the coarsest that keeps the limit counts.
    """
    kept = min((x for x, fraction in tried if fraction <= 1.0), default=math.inf)
    broken = max((x for x, fraction in tried if fraction > 1.0 and x < kept), default=0.0)
    if kept <= lowest * NEAR or broken * NEAR >= min(kept, highest):
        return None
    if broken > 0.0 and kept < math.inf:
        return _within(dict(tried), broken, kept, halve=len(tried) % HALVED == 0)
    last, fraction = tried[-1]
    step = math.sqrt(max(fraction, LEAST) / AIM)
    least = SMALLEST_STEP ** (2.0 ** (len(tried) - 1))
    step = min(step, 1.0 / least) if broken == 0.0 else max(step, least)
    return min(max(last * min(max(step, 1.0 / LARGEST_STEP), LARGEST_STEP), lowest), highest)


def _within(fractions: dict[float, float], broken: float, kept: float, halve: bool) -> float:
    """Between the ends of the bracket, by the line through them or in their middle."""
    width = math.log(kept / broken)
    above, below = (math.log(max(fractions[x], LEAST)) for x in (broken, kept))
    goal = math.log(MISS if fractions[kept] >= 1.0 / NEAR**2 else AIM)
    part = 0.5 if halve else min(max((above - goal) / (above - below), INSET), 1.0 - INSET)
    if not halve and fractions[kept] >= 1.0 / NEAR**2:  # close already: just aside of it
        part = max(part, 1.0 - math.log(NEAR) / width)
    return broken * math.exp(part * width)
