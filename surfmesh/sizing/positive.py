"""What counts as a size: a finite number above zero."""

import math

from surfmesh.errors import SizingError


def positive(name: str, value: object) -> float:
    """``value`` as a float. Raises ``SizingError`` that names it."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise SizingError(f"{name} must be a positive number, not {value!r}") from None
    if not (number > 0.0 and math.isfinite(number)):
        raise SizingError(f"{name} must be a positive number, not {value!r}")
    return number
