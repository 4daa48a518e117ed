"""A part of the report: a few figures on one subject."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Part:
    """In JSON its figures stand in the report itself, each by its own name."""


def over(measure: Callable[[Values], Any], values: Values) -> float:
    """A mean or an extreme of values (k,); nan where there are none."""
    return float(measure(values)) if len(values) else float("nan")
