"""Interval arithmetic on arrays: a function of an interval is an interval that holds its range.

An interval is a pair (lo, hi) of float arrays or floats. Bounds hold up to round-off, over the part
of the interval where the function is defined: sqrt([-1, 4]) is [0, 2]. Where nothing is known
the bounds are infinite. Callers silence numpy's warnings (``numpy.errstate``).

Source: Moore, Kearfott, Cloud, "Introduction to Interval Analysis", SIAM 2009, chapters 2-5.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

TAU = 2.0 * np.pi

Ends = np.ndarray | np.float64
Interval = tuple[Ends, Ends]


def known(lo: Ends, hi: Ends) -> Interval:
    """(lo, hi) with everything undecided (nan, reversed) replaced by the whole line."""
    undecided = ~(lo <= hi)
    if np.any(undecided):
        lo, hi = np.where(undecided, -np.inf, lo), np.where(undecided, np.inf, hi)
    return lo, hi


def add(a: Interval, b: Interval) -> Interval:
    return known(a[0] + b[0], a[1] + b[1])


def subtract(a: Interval, b: Interval) -> Interval:
    return known(a[0] - b[1], a[1] - b[0])


def negative(a: Interval) -> Interval:
    return -a[1], -a[0]


def multiply(a: Interval, b: Interval) -> Interval:
    corners = (a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1])
    lo = np.minimum(np.minimum(corners[0], corners[1]), np.minimum(corners[2], corners[3]))
    hi = np.maximum(np.maximum(corners[0], corners[1]), np.maximum(corners[2], corners[3]))
    return known(lo, hi)


def reciprocal(a: Interval) -> Interval:
    lo, hi = a
    # 1/[0, b] = [1/b, inf] and 1/[a, 0] = [-inf, 1/a]; a zero inside leaves nothing known
    low = np.where(hi == 0.0, -np.inf, 1.0 / hi)
    high = np.where(lo == 0.0, np.inf, 1.0 / lo)
    inside = (lo < 0.0) & (hi > 0.0)
    return known(np.where(inside, -np.inf, low), np.where(inside, np.inf, high))


def divide(a: Interval, b: Interval) -> Interval:
    return multiply(a, reciprocal(b))


def integer_power(a: Interval, n: int) -> Interval:
    """a**n for an integer n >= 2; tighter than repeated products when a holds 0."""
    low, high = np.power(a[0], n), np.power(a[1], n)
    if n % 2:
        return known(low, high)
    holds_zero = (a[0] <= 0.0) & (a[1] >= 0.0)
    return known(np.where(holds_zero, 0.0, np.minimum(low, high)), np.maximum(low, high))


def power(a: Interval, b: Interval) -> Interval:
    """a**b for a >= 0, monotone along both sides of the box; unknown where a is negative."""
    base = np.where(a[1] < 0.0, np.nan, np.maximum(a[0], 0.0)), a[1]
    corners = [np.power(x, y) for x in base for y in b]
    lo = np.minimum(np.minimum(corners[0], corners[1]), np.minimum(corners[2], corners[3]))
    hi = np.maximum(np.maximum(corners[0], corners[1]), np.maximum(corners[2], corners[3]))
    # 0**0 = 1 stands alone beside 0**y = 0
    return known(np.where((base[0] == 0.0) & (b[1] > 0.0), 0.0, lo), hi)


def sqrt(a: Interval) -> Interval:
    return known(np.sqrt(np.maximum(a[0], 0.0)), np.sqrt(a[1]))


def log(a: Interval) -> Interval:
    return known(np.log(np.maximum(a[0], 0.0)), np.log(a[1]))


def exp(a: Interval) -> Interval:
    return known(np.exp(a[0]), np.exp(a[1]))


def absolute(a: Interval) -> Interval:
    lo, hi = np.abs(a[0]), np.abs(a[1])
    holds_zero = (a[0] <= 0.0) & (a[1] >= 0.0)
    return known(np.where(holds_zero, 0.0, np.minimum(lo, hi)), np.maximum(lo, hi))


def minimum(a: Interval, b: Interval) -> Interval:
    return np.minimum(a[0], b[0]), np.minimum(a[1], b[1])


def maximum(a: Interval, b: Interval) -> Interval:
    return np.maximum(a[0], b[0]), np.maximum(a[1], b[1])


def sin(a: Interval) -> Interval:
    return _wave(a, np.sin, 0.25 * TAU)


def cos(a: Interval) -> Interval:
    return _wave(a, np.cos, 0.0)


def _wave(a: Interval, function: Callable[[Ends], Ends], crest: float) -> Interval:
    """Range of a wave of period 2 pi with a crest (+1) at `crest` and a trough half way on."""
    lo, hi = a
    first, last = function(lo), function(hi)

    def holds(phase: float) -> np.ndarray | np.bool_:
        # the widened ends keep a crest that sits on an end point, whatever its round-off
        slack = 1e-15 * (1.0 + np.abs(lo) + np.abs(hi))
        return np.ceil((lo - slack - phase) / TAU) * TAU + phase <= hi + slack

    unknown = ~np.isfinite(lo) | ~np.isfinite(hi)
    low = np.where(holds(crest + 0.5 * TAU) | unknown, -1.0, np.minimum(first, last))
    high = np.where(holds(crest) | unknown, 1.0, np.maximum(first, last))
    return low, high


def tan(a: Interval) -> Interval:
    lo, hi = a
    branch = np.floor(lo / np.pi + 0.5) == np.floor(hi / np.pi + 0.5)
    branch &= (hi - lo) < np.pi
    return known(np.where(branch, np.tan(lo), -np.inf), np.where(branch, np.tan(hi), np.inf))


def asin(a: Interval) -> Interval:
    return known(np.arcsin(np.clip(a[0], -1.0, None)), np.arcsin(np.clip(a[1], None, 1.0)))


def acos(a: Interval) -> Interval:
    return known(np.arccos(np.clip(a[1], None, 1.0)), np.arccos(np.clip(a[0], -1.0, None)))


def cosh(a: Interval) -> Interval:
    lo, hi = absolute(a)
    return known(np.cosh(lo), np.cosh(hi))


def acosh(a: Interval) -> Interval:
    return known(np.arccosh(np.maximum(a[0], 1.0)), np.arccosh(a[1]))


def atanh(a: Interval) -> Interval:
    return known(np.arctanh(np.maximum(a[0], -1.0)), np.arctanh(np.minimum(a[1], 1.0)))


def angle(y: Interval, x: Interval) -> Interval:
    """atan2 over a box: extremes are at corners unless the box meets the cut x <= 0, y = 0."""
    corners = [np.arctan2(p, q) for p in y for q in x]
    lo = np.minimum(np.minimum(corners[0], corners[1]), np.minimum(corners[2], corners[3]))
    hi = np.maximum(np.maximum(corners[0], corners[1]), np.maximum(corners[2], corners[3]))
    cut = (x[0] <= 0.0) & (y[0] <= 0.0) & (y[1] >= 0.0)
    return known(np.where(cut, -np.pi, lo), np.where(cut, np.pi, hi))


def increasing(function: Callable[[Ends], Ends]) -> Callable[[Interval], Interval]:
    """The interval version of a function that increases everywhere."""

    def over_interval(a: Interval) -> Interval:
        return known(function(a[0]), function(a[1]))

    return over_interval


def turn(y: Interval, x: Interval) -> Interval:
    """``angle`` up to whole turns: from the other side where the box meets the cut."""
    cut = (x[0] <= 0.0) & (y[0] <= 0.0) & (y[1] >= 0.0)
    lo, hi = angle(y, x)
    back_lo, back_hi = angle(negative(y), negative(x))
    behind = cut & (x[1] < 0.0)
    return np.where(behind, back_lo + np.pi, lo), np.where(behind, back_hi + np.pi, hi)


def step(a: Interval) -> Interval:
    """Heaviside's function, as it is at the ends too."""
    return np.heaviside(a[0], 0.5), np.heaviside(a[1], 0.5)


AT_THE_END = 1e-12
"""Of an interval: a zero so near to one of its ends counts as no break inside."""


def _inside(a: Interval) -> np.ndarray | np.bool_:
    """Is zero inside the interval, not only at one of its ends?"""
    slack = AT_THE_END * np.maximum(np.abs(a[0]), np.abs(a[1]))
    return ((a[0] < -slack) & (a[1] > slack)) | ((a[0] == 0.0) & (a[1] == 0.0))


def slope_step(a: Interval) -> Interval:
    """0 or 1, the slope of max(x, 0): one-sided at the ends, where the other side is not seen."""
    inside, above = _inside(a), a[1] > -a[0]
    return np.where(inside | ~above, 0.0, 1.0), np.where(inside | above, 1.0, 0.0)


def slope_side(a: Interval) -> Interval:
    """-1 or 1, the slope of |x|: likewise."""
    lo, hi = slope_step(a)
    return 2.0 * lo - 1.0, 2.0 * hi - 1.0


def _unbounded_where(broken: np.ndarray | np.bool_) -> Interval:
    return np.where(broken, -np.inf, 0.0), np.where(broken, np.inf, 0.0)


def kink(a: Interval) -> Interval:
    """The slope of a slope that jumps at 0: nothing is known where that is inside."""
    return _unbounded_where(_inside(a) | ~(a[0] <= a[1]))


def jump(a: Interval) -> Interval:
    """The slope of a value that jumps at 0: nothing is known where that is in the interval."""
    return _unbounded_where(~((a[0] > 0.0) | (a[1] < 0.0)))


def tread(a: Interval) -> Interval:
    """The slope of floor(x)."""
    return _unbounded_where(~((np.floor(a[0]) == np.floor(a[1])) & (np.floor(a[0]) < a[0])))


def cut(y: Interval, x: Interval) -> Interval:
    """What the slope of ``angle`` has beside its smooth part."""
    return _unbounded_where(~((x[0] > 0.0) | (y[0] > 0.0) | (y[1] < 0.0)))


def chosen(d: Interval, a: Interval, b: Interval) -> Interval:
    """a where d >= 0, else b."""
    never, always = d[1] < 0.0, d[0] >= 0.0
    lo = np.where(always, a[0], np.where(never, b[0], np.minimum(a[0], b[0])))
    hi = np.where(always, a[1], np.where(never, b[1], np.maximum(a[1], b[1])))
    return known(lo, hi)


def steady(
    function: Callable[[Ends], Ends], rate: float, lowest: float, highest: float
) -> Callable[[Interval], Interval]:
    """The interval version of a function whose slope is at most ``rate``, between two bounds."""

    def over_interval(a: Interval) -> Interval:
        reach = 0.5 * rate * (a[1] - a[0])
        middle = function(0.5 * (a[0] + a[1]))
        lo, hi = np.maximum(middle - reach, lowest), np.minimum(middle + reach, highest)
        known_there = lo <= hi  # not where an end is infinite
        return np.where(known_there, lo, lowest), np.where(known_there, hi, highest)

    return over_interval
