"""The sign of a sum of numbers of any size, exactly: what predicates fall back on.

A number here is a double times a power of two whose exponent is an integer of its own, so that
no product of coordinates under- or overflows.
"""

import math

import numpy as np

from surfmesh.kernels.jit import kernel

DIGITS = 53
LARGEST = 1.7976931348623157e308
LEAST = 5e-324


@kernel
def exact_sum(terms, exponents, count):
    """About the sum of terms[k] 2**exponents[k]; its sign is exact, and it is finite.

    Each term is an integer below 2**53 times a unit, a power of two. They are added from the
    largest unit down. What is summed so far is either larger than all that may still come, and
    has the sign of the sum, or less than (count + 1) 2**53 of the next unit: an int64 holds it.

    Parameters
    ----------
    terms: at least count numbers, finite; count is at most 255
    exponents: as many integers, of any number type
    """
    total, unit, left = np.int64(0), np.int64(2**20), count
    while left > 0:
        below = np.int64(-(2**20))
        for k in range(count):
            here = _unit(terms[k], exponents[k])
            if below < here < unit:
                below = here
        if below == -(2**20):
            break  # what is left are zeros
        gap = unit - below
        if total != 0 and (gap > 62 or math.ldexp(abs(total), gap) >= (left + 1) * 2.0**DIGITS):
            break
        total = total << gap if total != 0 else total
        unit = below
        for k in range(count):
            if _unit(terms[k], exponents[k]) == unit:
                total += np.int64(math.ldexp(math.frexp(terms[k])[0], DIGITS))
                left -= 1
    if total == 0:
        return 0.0
    size = math.ldexp(abs(total), max(min(unit, 2000), -2000))
    return math.copysign(min(max(size, LEAST), LARGEST), total)


@kernel
def _unit(term, exponent):
    """Exponent of the unit of a term; out of reach for zero."""
    if term == 0.0:
        return np.int64(-(2**20))
    return np.int64(math.frexp(term)[1] - DIGITS) + np.int64(exponent)
