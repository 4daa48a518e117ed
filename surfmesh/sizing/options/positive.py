"""What counts as a size: a finite number above zero."""

import math
from typing import Any

import numpy as np

from surfmesh.errors import SizingError, shown
from surfmesh.geometry.number_range import RANGE


def positive(name: str, value: Any) -> float:
    """``value`` as a float. Raises ``SizingError`` that names it."""
    try:
        number = math.nan if isinstance(value, (bool, np.bool_)) or np.ndim(value) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not (number > 0.0 and math.isfinite(number)):
        raise SizingError(f"{name} must be a positive number, not {shown(value)}")
    if number < RANGE.size:
        raise SizingError(
            f"{name} must be at least {RANGE.size:g}, not {number:g}: change the unit"
        )
    return number
