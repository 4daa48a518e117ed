"""
Sine, cosine, exponential and the like: one implementation, the same bits everywhere.
"""

from typing import Annotated, overload

import numpy
from numpy.typing import NDArray


@overload
def sin(x: float) -> float:
    """Sine; error below 0.85 ulp."""

@overload
def sin(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def cos(x: float) -> float:
    """Cosine; error below 0.85 ulp."""

@overload
def cos(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def tan(x: float) -> float:
    """Tangent; error below 1 ulp."""

@overload
def tan(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """Likewise, for each number of an array."""

@overload
def sincos(x: float) -> tuple[float, float]:
    """Sine and cosine, those of ``sin`` and ``cos``."""

@overload
def sincos(x: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
    """Likewise, for each number of an array."""
