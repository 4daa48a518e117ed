"""The coarsest setting of a mesher whose mesh keeps to a limit: a bisection that looks ahead.

A setting is a fineness x: the deviation falls about as x^-2, the triangles grow as x^2. What is
looked for is the smallest x that keeps the limit; the law above places the next attempt, and
where it would leave the bracket, or barely shrink it, the bracket is halved in log x.
"""

import math
from collections.abc import Sequence

import numpy as np

ALLOWED = 0.001  # share of the triangles that may lie farther away
NEAR = 1.02  # ratio of the bracket's ends: 4 % of the triangles are not worth another attempt
AIM = 0.96  # of the limit: the law's next attempt should keep it
LARGEST_STEP = 4.0  # factor on x, when there is no bracket yet
SMALLEST_STEP = 1.05
INSET = 0.1  # share of the bracket, in log x, that an attempt takes off it at least


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
    kept = min((x for x, share in tried if share <= 1.0), default=math.inf)
    broken = max((x for x, share in tried if share > 1.0 and x < kept), default=0.0)
    if kept <= lowest * NEAR or broken * NEAR >= min(kept, highest):
        return None
    last, share = tried[-1]
    step = math.sqrt(max(share, 0.0) / AIM)
    wanted = last * min(max(step, 1.0 / LARGEST_STEP), LARGEST_STEP)
    if broken == 0.0:
        wanted = min(wanted, kept / SMALLEST_STEP)
    elif kept == math.inf:
        wanted = max(wanted, broken * SMALLEST_STEP)
    else:
        inset = (kept / broken) ** INSET
        if not broken * inset <= wanted <= kept / inset:
            wanted = math.sqrt(broken * kept)
    return min(max(wanted, lowest), highest)
