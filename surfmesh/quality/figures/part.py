"""A part of the report: a few figures on one subject."""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import spread

Values = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Part:
    """In JSON its figures stand in the report itself, each by its own name."""


class Spread(NamedTuple):
    """Of values: nan where there are none."""

    least: float
    mean: float
    largest: float
    deviation: float  # standard

    @classmethod
    def of(cls, values: Values) -> Self:
        """values: (k,)"""
        return cls(*spread(values))
