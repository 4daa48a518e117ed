"""What counts as a size: a finite number above zero."""

import math

from surfmesh.errors import SizingError

LEAST = 1e-150
"""Below it the number of triangles, which goes with 1 / size^2, is no number any more."""


def positive(name: str, value: object) -> float:
    """``value`` as a float. Raises ``SizingError`` that names it."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise SizingError(f"{name} must be a positive number, not {value!r:.60}") from None
    except OverflowError:  # a whole number; its digits may be too many to be shown
        raise SizingError(f"{name} must be a positive number, not one above 1e308") from None
    if not (number > 0.0 and math.isfinite(number)):
        raise SizingError(f"{name} must be a positive number, not {value!r:.60}")
    return number


def countable(name: str, value: object) -> float:
    """The same for what bounds sizes from above: triangles of that size can be counted."""
    number = positive(name, value)
    if number < LEAST:
        raise SizingError(
            f"{name} {number:g} asks for more triangles than can be counted; the smallest is "
            f"{LEAST:g}"
        )
    return number
